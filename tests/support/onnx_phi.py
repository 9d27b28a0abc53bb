# onnx_phi.py: evaluates an ONNX model by onnxruntime, for test_onnx.cpp.
# Usage: python3 onnx_phi.py MODEL POINTS CODE OUTPUT   (files of float32; CODE "-": the model takes none)
# Exit code 77 where numpy or onnxruntime cannot be imported.
# SPDX-License-Identifier: Apache-2.0
import sys

try:
    import numpy as np
    import onnxruntime
except ImportError:
    sys.exit(77)

model, points, code, output = sys.argv[1:]
options = onnxruntime.SessionOptions()
options.intra_op_num_threads = 1
session = onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
inputs = {"x": np.fromfile(points, np.float32).reshape(-1, 3)}
if code != "-":
    inputs["code"] = np.fromfile(code, np.float32).reshape(1, -1)
session.run(["phi"], inputs)[0].astype(np.float32).tofile(output)
for key, value in sorted(session.get_modelmeta().custom_metadata_map.items()):
    print(f"{key}={value}")
