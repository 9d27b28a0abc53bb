// bad_physics_test.cpp: physics that cannot be is refused, each with its key, its value and the reason.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/simulation_impl.h"
#include "shapes/mesh_files.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

char const* const good = R"([time]
end = 0.02
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6 }
[[grains]]
name = "egg"
material = "rock"
shapes = ["ellipsoid:1:0.8:0.6"]
nodes = 250
diameter = 0.1
count = 3
insert = { kind = "lattice", box = [[0, 0, 0], [0.5, 0.5, 0.5]] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
)";

class BadPhysics : public ::testing::Test {
 protected:
  BadPhysics() : folder(fs::temp_directory_path() / ("scree_bad_physics_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    std::ofstream(folder / "case.toml") << good;
    TriangleMesh lidless;
    for (int i = 0; i < 8; ++i) lidless.vertex.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
    lidless.triangle = {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7},
                        {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    write_mesh(folder / "lidless.stl", lidless);
  }
  ~BadPhysics() override { fs::remove_all(folder); }

  Case load(std::string const& key) const {
    return load_case(folder / "case.toml", key.empty() ? std::vector<std::string>{} : std::vector{key});
  }

  // What refuses the case with this key, as `scree check` says it.
  std::vector<std::string> refusal(std::string const& key) const {
    try {
      Simulation(load(key), {});
    } catch (InputError const& error) {
      return error.problems;
    }
    return {};
  }
  fs::path folder;
};

struct Bad {
  char const* key;                 // as for --set
  std::vector<char const*> words;  // of the only message: which key, what is wrong, why or what to do
};

std::vector<Bad> const table{
    {"contact.0.friction=-0.1", {"contact.0.friction: -0.1", "must be >= 0", "drive the motion"}},
    {"contact.0.friction=nan", {"contact.0.friction: nan", "must be >= 0"}},
    {"contact.0.damping.restitution=1.2", {"damping.restitution: 1.2", "> 0 and <= 1", "energy would be made"}},
    {"contact.0.damping.restitution=-0.2", {"damping.restitution: -0.2", "> 0 and <= 1"}},
    {"contact.0.damping.restitution=0", {"damping.restitution: 0", "> 0 and <= 1"}},
    {"contact.0.damping.restitution=nan", {"damping.restitution: nan", "> 0 and <= 1"}},
    {"contact.0.damping.restitution=0.001", {"damping.restitution: 0.001", "below what damping reaches", "ratio"}},
    {"contact.0.damping.ratio=-0.1", {"damping.ratio: -0.1", "must be >= 0", "add energy"}},
    {"contact.0.damping.ratio=11", {"damping.ratio: 11", "<= ", "critical damping"}},
    {"contact.0.rolling.friction=-0.1", {"rolling.friction: -0.1", "must be >= 0", "drive the rolling"}},
    {"contact.0.cohesion={traction=1e3,range=-1e-4}", {"cohesion.range: -0.0001", "must be >= 0", "surface"}},
    {"contact.0.cohesion={traction=-1e3,range=1e-4}", {"cohesion.traction: -1000", "must be >= 0", "repel"}},
    {"contact.0.normal.stiffness=-2e6", {"normal.stiffness: -2", "must be > 0", "N/m"}},
    {"contact.0.normal.stiffness=0", {"normal.stiffness: 0", "must be > 0", "N/m"}},
    {"contact.0.normal.stiffness=nan", {"normal.stiffness: nan", "must be > 0", "N/m"}},
    {"contact.0.normal={kappa=-1e9}", {"normal.kappa: -1", "must be > 0", "N/m3"}},
    {"contact.0.tangential_ratio=-1", {"tangential_ratio: -1", "must be > 0"}},
    {"material.0.density=-2650", {"material.rock.density: -2650", "must be > 0", "kg/m3"}},
    {"material.0.density=0", {"material.rock.density: 0", "must be > 0", "kg/m3"}},
    {"material.0.density=nan", {"material.rock.density: nan", "must be > 0"}},
    {"material.0.density=inf", {"material.rock.density: inf", "finite"}},
    {"grains.0.diameter=0", {"grains.egg.diameter: 0", "must be > 0", "equal-volume sphere"}},
    {"grains.0.diameter=-0.1", {"grains.egg.diameter: -0.1", "must be > 0"}},
    {"grains.0.diameter=[0,0.1]", {"grains.egg.diameter: 0", "must be > 0", "least diameter"}},
    {"grains.0.diameter=[0.1,0.05]", {"grains.egg.diameter: 0.1", "<= 0.05", "least diameter"}},
    {"grains.0.insert.velocity=[0,0,nan]", {"grains.egg.insert.velocity", "nan", "must be finite"}},
    {"grains.0.insert={kind=\"list\",position=[[0,0,1],[0,nan,2],[0,0,3]]}",
     {"grains.egg.insert.position", "nan", "must be finite"}},
    // Insertions without a place.
    {"grains.0.count=100000", {"grains.egg.insert.box", "holds at most", "enlarge it or insert fewer"}},
    {"grains.0.insert.box=[[0,0,0],[0.2,0.2,0.14]]", {"grains 'egg'", "insert.box holds 1 ", "3 are to start in it"}},
    {"grains.0.insert={kind=\"random\",box=[[0,0,0],[0.13,0.13,0.13]]}",
     {"grains 'egg': grain 2 of 3", "found no free place", "Make the box larger or count smaller"}},
    {"grains.0.insert={kind=\"random\",box=[[0,0,-2],[1,1,-1]]}", {"grain 1 of 3", "in front of the walls"}},
    {"grains.0.insert={kind=\"rate\",rate=100,box=[[0,0,-2],[1,1,-1]]}",
     {"grains 'egg'", "no place in insert.box", "in front of the walls", "even while it is empty"}},
    {"grains.0.insert={kind=\"rate\",rate=0,box=[[0,0,0],[1,1,1]]}", {"insert.rate: 0", "must be > 0"}},
    {"grains.0.insert={kind=\"lattice\",box=[[0,0,-2],[1,1,-1]]}",
     {"grains 'egg': 3 of 3 grains start inside a wall", "wall 'floor'", "behind its normal"}},
    {"grains.0.insert={kind=\"list\",position=[[0,0,1],[0,0,-0.01],[0,0,3]]}",
     {"grains 'egg': 1 of 3 grains start inside a wall", "grain 2 at [0, 0, -0.01] m inside wall 'floor'"}},
    // Walls.
    {"wall.0.normal=[0,0,0]", {"wall.floor.normal", "must have a length", "free space"}},
    {"wall.0.point=[0,0,inf]", {"wall.floor.point", "must be finite"}},
    {"wall.0={name=\"floor\",material=\"rock\",kind=\"mesh\",file=\"lidless.stl\"}",
     {"wall 'floor'", "lidless.stl", "is open along 4 edges", "needs its thickness"}},
    {"wall.0={name=\"floor\",material=\"rock\",kind=\"mesh\",file=\"lidless.stl\",thickness=-0.1}",
     {"wall.floor.thickness: -0.1", "must be > 0"}},
    {"wall.0={name=\"w\",material=\"rock\",kind=\"box\",min=[0,0,0],max=[1,1,1],open=[\"-x\",\"+x\",\"-y\",\"+y\","
     "\"-z\",\"+z\"]}",
     {"wall.w.open", "no face", "nothing is left"}},
    {"wall.0={name=\"w\",material=\"rock\",kind=\"cylinder\",from=[0,0,0],to=[0,0,inf],radius=1}",
     {"wall.w.to", "must be finite"}},
    {"wall.0={name=\"w\",material=\"rock\",kind=\"cylinder\",from=[0,0,0],to=[0,0,1],radius=-1}",
     {"wall.w.radius: -1", "above 0"}},
    {"wall.0.motion={kind=\"rotation\",axis=[0,0,1],through=[0,0,0],rate=nan}",
     {"wall.floor.motion.rate", "must be finite"}},
    // Time, effects on bodies.
    {"time.step=-1e-5", {"time.step: -1e-05", "must be > 0", "auto"}},
    {"time.step=nan", {"time.step: nan", "must be > 0", "auto"}},
    {"time.step=0.1", {"time.step: 0.1", "<= 0.02", "at most time.end"}},
    {"time.end=inf", {"time.end: inf", "finite"}},
    {"time.safety=2", {"time.safety: 2", "<= 1", "unstable"}},
    {"gravity.acceleration=[0,0,nan]", {"gravity.acceleration", "nan", "must be finite"}},
    {"drag={density=-1,coefficient=0.5}", {"drag.density: -1", "must be >= 0", "kg/m3"}},
    {"drag={density=1,coefficient=-0.5}", {"drag.coefficient: -0.5", "must be >= 0", "drive the motion"}},
    {"damping.rate=-1", {"damping.rate: -1", "must be >= 0", "add energy"}},
};

TEST_F(BadPhysics, IsRefusedWithTheReason) {
  ASSERT_EQ(refusal(""), std::vector<std::string>{});
  for (Bad const& bad : table) {
    std::vector<std::string> const said = refusal(bad.key);
    ASSERT_EQ(said.size(), 1u) << bad.key << "\n" << ::testing::PrintToString(said);
    for (char const* word : bad.words)
      EXPECT_NE(said[0].find(word), std::string::npos) << bad.key << "\n" << said[0] << "\nlacks: " << word;
  }
}

TEST_F(BadPhysics, GrainsThatStartInEachOtherAreNamed) {
  Simulation s(load("grains.0.insert={kind=\"list\",position=[[0,0,1],[0,0,1.03],[0,1,1]]}"), {});
  try {
    s.step();
    FAIL() << "it ran";
  } catch (WatchStop const& stop) {
    std::string const text = stop.what();
    EXPECT_NE(text.find("step 1: grain 0"), std::string::npos) << text;
    EXPECT_NE(text.find("They start in each other: move them apart"), std::string::npos) << text;
  }
}

// A step above the critical one: announced before the run, and the run stops at the first contact that cannot work.
TEST_F(BadPhysics, AStepAboveCriticalIsAnnouncedAndStops) {
  auto const announced = [&](double share) {
    double const critical = Simulation(load(""), {}).impl().estimate.critical;
    Simulation s(load("time.step=" + std::to_string(share * critical)), {});
    for (std::string const& note : s.plan().notes)
      if (note.starts_with("critical step")) return note;
    return std::string();
  };
  EXPECT_NE(announced(0.4).find("of it"), std::string::npos);
  EXPECT_EQ(announced(0.4).find("auto"), std::string::npos);
  EXPECT_NE(announced(0.7).find("above 0.5 the energy ledger suffers; use step = \"auto\""), std::string::npos);
  EXPECT_NE(announced(3).find("contacts are unstable"), std::string::npos);
  Case c = load("");
  c.time.step = 2e-3;
  c.time.end = 1;
  Simulation s(c, {});
  try {
    while (s.step() == RunState::running) {
    }
    FAIL() << "it ran";
  } catch (WatchStop const& stop) {
    EXPECT_NE(std::string(stop.what()).find("of the critical step"), std::string::npos) << stop.what();
    EXPECT_NE(std::string(stop.what()).find("use step = \"auto\""), std::string::npos) << stop.what();
  }
}

}  // namespace
}  // namespace scree
