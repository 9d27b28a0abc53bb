// pouring_case.h: the text of a case whose run has frictional contacts, insertion and measurements; for program tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace scree::testing {

// Numbers as the case file has them.
struct Pouring {
  std::string end, step;  // [s]
  std::string rate;       // grains a second
  std::string sampled;    // interval of a measurement [s]
  std::string every;      // of the frames [s]
};

// 12 spheres with friction that pour into a box; ends within [output].
inline std::string pouring_case(Pouring const& p) {
  return R"([case]
name = "pour"
[time]
end = )" +
         p.end + R"(
step = )" +
         p.step + R"(
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e5 }
friction = 0.5
[[grains]]
name = "balls"
material = "rock"
shapes = ["sphere"]
evaluator = "analytic"
count = 12
diameter = 0.05
insert = { kind = "rate", box = [[0.05, 0.05, 0.05], [0.25, 0.25, 0.25]], rate = )" +
         p.rate + R"(, velocity = [0.3, 0, -1] }
[[wall]]
name = "box"
kind = "box"
min = [0, 0, 0]
max = [0.3, 0.3, 0.3]
open = ["+z"]
material = "rock"
[[measure]]
name = "pull"
kind = "wall_force"
wall = "box"
every = )" +
         p.sampled + R"(
[[measure]]
name = "chains"
kind = "force_chains"
contacts = true
[output]
every = )" +
         p.every + R"(
)";
}

}  // namespace scree::testing
