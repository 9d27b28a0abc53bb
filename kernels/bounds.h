// bounds.h: world boxes of all bodies, walls included.
// A body's box is that of its zero set, turned, so a node that touches lies in both boxes of its pair.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/queue.h"
#include "kernels/views.h"

namespace scree {

// box[i] = axis-aligned box of solid i, grown by skin[i] [m] on every side; empty for inactive bodies (n_solids).
void compute_bounds(Queue const& queue, SceneView const& scene, StateView const& state, Span<const double> skin,
                    Span<Box> box);

}  // namespace scree
