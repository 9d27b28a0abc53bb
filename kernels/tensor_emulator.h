// tensor_emulator.h: tiles of the tensor core kernel on the host, lane by lane.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/network_device.h"
#include "kernels/sdf/tensor_image.h"

namespace scree::sdf_fused {

// `precision`: fp16x3 or fast.
void run_tensor_tiles(NetworkClass const& of, TensorClass const& tensors, Precision precision, Queries const& queries,
                      std::vector<Tile> const& tiles);

}  // namespace scree::sdf_fused
