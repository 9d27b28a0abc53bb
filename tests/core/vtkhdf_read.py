# vtkhdf_read.py: reads a VTKHDF time series with VTK's own reader and writes what it finds as plain numbers.
# Usage: vtkhdf_read.py FILE FOLDER; the times go into FOLDER/time, every array of step k into FOLDER/<k>.<name>, points
# and cells too, all as doubles. Exit status 77 where VTK 9.3, the first to read such files, or later is missing.
# SPDX-License-Identifier: Apache-2.0
import sys
from array import array
from pathlib import Path

try:
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError:
    sys.exit(77)
if (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) < (9, 3):
    sys.exit(77)


def write(path, tuples):
    with open(path, "wb") as file:
        array("d", [number for row in tuples for number in row]).tofile(file)


folder = Path(sys.argv[2])
reader = vtkHDFReader()
if not reader.CanReadFile(sys.argv[1]):
    sys.exit(f"{sys.argv[1]}: not a VTKHDF file")
reader.SetFileName(sys.argv[1])
reader.UpdateInformation()
times = reader.GetOutputInformation(0).Get(reader.GetExecutive().TIME_STEPS())
write(folder / "time", [times])
for step, time in enumerate(times):
    reader.UpdateTimeStep(time)
    if reader.GetErrorCode():
        sys.exit(f"step {step}: VTK error {reader.GetErrorCode()}")
    data = reader.GetOutput()
    write(folder / f"{step}.points", [data.GetPoint(i) for i in range(data.GetNumberOfPoints())])
    cells = []  # VTK's number of the type of a cell (1: vertex), then its points
    for i in range(data.GetNumberOfCells()):
        cell = data.GetCell(i)
        cells.append([cell.GetCellType()] + [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())])
    write(folder / f"{step}.cells", cells)
    for a in range(data.GetPointData().GetNumberOfArrays()):
        values = data.GetPointData().GetArray(a)
        write(folder / f"{step}.{values.GetName()}", [values.GetTuple(i) for i in range(values.GetNumberOfTuples())])
