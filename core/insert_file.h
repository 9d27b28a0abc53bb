// insert_file.h: starting poses from a table of comma-separated values.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/case.h"

namespace scree {

// Fills position and, where the file has their columns, quaternion, velocities, spins and shape of `insert` from
// insert.file. The first line names the columns, in any order: x y z [m] | qw qx qy qz (body to world) | vx vy vz [m/s]
// | wx wy wz (world) [rad/s] | shape (index into the entry's shapes, from 0); each group whole or not at all. Throws
// std::runtime_error naming file, line and what was wrong.
void read_insert_file(InsertCase& insert);

}  // namespace scree
