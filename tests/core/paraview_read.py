# paraview_read.py: reads every file of a ParaView export with VTK's own reader and prints what it finds.
# Usage: paraview_read.py FOLDER; exit status 77 where VTK for Python is not installed.
# SPDX-License-Identifier: Apache-2.0
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    sys.exit(77)


def describe(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    if reader.GetErrorCode():
        sys.exit(f"{path}: VTK error {reader.GetErrorCode()}")
    data = reader.GetOutput()
    arrays = [data.GetPointData().GetArrayName(i) for i in range(data.GetPointData().GetNumberOfArrays())]
    arrays += [data.GetCellData().GetArrayName(i) for i in range(data.GetCellData().GetNumberOfArrays())]
    bounds = " ".join(f"{b:.4f}" for b in data.GetBounds())
    return f"points {data.GetNumberOfPoints()} cells {data.GetNumberOfCells()} bounds {bounds} arrays {' '.join(sorted(arrays))}"


folder = Path(sys.argv[1])
for collection in ("scene.pvd", "grains.pvd"):
    for entry in xml.parse(folder / collection).getroot().iter("DataSet"):
        print(collection, entry.get("timestep"), entry.get("file"), describe(folder / entry.get("file")))
