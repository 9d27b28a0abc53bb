// case_keys.cpp: see case_keys.h. Long for being a table of text.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_keys.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <unordered_map>

namespace scree {
namespace {

CaseKey constexpr table[] = {
    {"case", "", "", "what the run is called, and its random choices"},
    {"case.name", "", "file name", "what the run is called"},
    {"case.seed", "", "", "of every random choice, >= 0"},
    {"case.replicas", "[1, 1e8]", "",
     "independent copies of all grains in one run, 1e8 grains in all, see "
     "[Replicas](#replicas-and-entries-apart)"},

    {"time", "", "", "how long, and in which steps"},
    {"time.end", "(0, inf)", "", "simulated time [s]"},
    {"time.step", "(0, inf)", "`\"auto\"`", "time step [s], at most `time.end`, or `\"auto\"`"},
    {"time.safety", "(0, 1]", "", "automatic step as a share of the critical one"},
    {"time.settle", "", "no settling", "damp, release, and stop when at rest"},
    {"time.settle.damping", "[0, inf)", "", "global damping while settling [1/s]"},
    {"time.settle.after", "[0, inf)", "", "switched on at [s]"},
    {"time.settle.kinetic_per_grain", "(0, inf)", "",
     "at rest when no grain has more kinetic energy than this [m g d]"},
    {"time.settle.hold", "[0, inf)", "", "... for this long with the damping released; the run ends then [s]"},

    {"accuracy", "", "node counts and steps as the case gives them",
     "forces as accurate as asked for, as cheaply as this machine can: picks `grains.nodes` and `time.safety`, see "
     "[Accuracy](#accuracy)"},
    {"accuracy.budget", "[1e-3, 0.5]", "this or `preset`", "largest relative error of a contact's force"},
    {"accuracy.preset", "", "this or `budget`",
     "`\"fast\"` = 0.15, about 1,000 nodes on round grains in contacts 1 % d deep, `\"balanced\"` = 0.03, about 4,000, "
     "`\"reference\"` = 0.003, about 32,000"},
    {"accuracy.overlap", "(0, 0.1]", "of an impact at half the worst speed",
     "how deep the contacts are that the budget is for [d]; lighter ones err more"},

    {"gravity", "", "no gravity", "on all grains"},
    {"gravity.acceleration", "", "", "[m/s2]"},

    {"drag", "", "no drag", "quadratic drag of the equal-volume sphere; a turning body feels none"},
    {"drag.density", "[0, inf)", "", "of the fluid [kg/m3]"},
    {"drag.coefficient", "[0, inf)", "", "C_d, about 0.5 for a sphere"},
    {"drag.fluid_velocity", "", "", "of the fluid [m/s]"},

    {"damping", "", "no damping", "of the motion of all grains, all the time"},
    {"damping.rate", "[0, inf)", "", "velocities and spins decay by exp(-rate t) [1/s]"},

    {"force", "", "no force", "a force and a torque on every grain of one `[[grains]]` entry"},
    {"force.name", "", "", "of this entry"},
    {"force.grains", "", "", "name of the `[[grains]]` entry"},
    {"force.force", "", "", "world axes, at the centroid, on each grain [N]; this, `torque` or both"},
    {"force.torque", "", "", "... [N m]"},
    {"force.start", "", "", "acts from [s]"},
    {"force.stop", "", "the end", "... to, after `start` [s]"},
    {"force.table", "", "none",
     "instead of `start` and `stop`: `[[time, factor], ...]` scales force and torque, linear in "
     "between, constant beyond its ends; two equal times make a jump"},

    {"delete", "", "none",
     "grains whose centroid leaves the kept space are gone for good, with an entry of their own in "
     "the ledger"},
    {"delete.name", "", "", "of this entry"},
    {"delete.kind", "", "", "what bounds the kept space"},
    {"delete.side", "", "", "which ones leave: those outside the box, or those inside"},
    {"delete.min", "", "", "corner [m]"},
    {"delete.max", "", "", "corner, above `min` on every axis [m]"},
    {"delete.point", "", "", "a point of the plane [m]"},
    {"delete.normal", "", "", "points into the space that is kept, any length"},

    {"library", "", "none", "model files that shapes come from"},
    {"library.name", "", "", "the word that shapes use for it; not `mesh`"},
    {"library.file", "", "", "the model file"},

    {"material", "", "", "what grains and walls are made of"},
    {"material.name", "", "", "of this entry"},
    {"material.density", "(0, inf)", "", "[kg/m3]"},

    {"contact", "", "", "what happens where two materials touch; every pair that can touch needs an entry"},
    {"contact.pair", "", "", "two material names, the same one twice for a material with itself"},
    {"contact.law", "", "", "pressure on the surface over the overlap, see [Contact laws](#contact-laws)"},
    {"contact.normal", "", "", "its constants"},
    {"contact.normal.stiffness", "(0, inf)", "required by winkler (or `kappa`) and linear",
     "winkler: secant stiffness at `at_overlap`, on a radius d/4; linear: k_n between equal grains [N/m]"},
    {"contact.normal.kappa", "(0, inf)", "from `stiffness`",
     "winkler, instead of `stiffness`: the constant itself [N/m3]"},
    {"contact.normal.at_overlap", "(0, 0.1]", "",
     "overlap of that secant; linear, hertz: of the secant that scales the friction stiffness [d of the largest "
     "grain]"},
    {"contact.normal.onset", "(0, 0.1]", "",
     "linear: overlap at which the pressure is reached [d of the largest grain]"},
    {"contact.normal.youngs_modulus", "(0, inf)", "required by hertz",
     "hertz: E of both bodies [Pa]; E* = E / (2 (1 - nu^2))"},
    {"contact.normal.poisson_ratio", "(-1, 0.5)", "required by hertz", "hertz: nu of both bodies"},
    {"contact.tangential_ratio", "(0, 2]", "", "k_t / k_n; times the secant p/overlap of the law"},
    {"contact.friction", "[0, inf)", "frictionless", "coefficient; without it no contact history exists"},
    {"contact.damping", "", "undamped", "of the normal motion; exactly one of its keys"},
    {"contact.damping.ratio", "[0, 10]", "", "share of critical damping; or"},
    {"contact.damping.restitution", "(0, 1]", "",
     "rebound over impact speed; at least what `ratio` = 10 gives, 0.002 to 0.005 by law"},
    {"contact.rolling", "", "no rolling resistance", "see [Rolling resistance](#rolling-resistance)"},
    {"contact.rolling.friction", "[0, inf)", "", "mu_r: a sphere rests on slopes up to tan(angle) = mu_r"},
    {"contact.rolling.stiffness_ratio", "(0, inf)", "", "k_r / (K (mu_r R)^2)"},
    {"contact.rolling.damping", "[0, 1]", "", "share of the critical damping of rolling"},
    {"contact.cohesion", "", "no cohesion", "see [Cohesion](#cohesion)"},
    {"contact.cohesion.traction", "[0, inf)", "", "adhesive traction [Pa] ..."},
    {"contact.cohesion.range", "[0, inf)", "", "... up to this distance outside the surface [m]"},

    {"grains", "", "none", "grains of one kind"},
    {"grains.name", "", "", "of this entry"},
    {"grains.material", "", "", "name of a `[[material]]`"},
    {"grains.shapes", "", "this, `sample` or `interpolate`",
     "shared out equally: `\"library:pattern\"` with `*`; `\"mesh:file.stl\"` (closed mesh, STL, OBJ or PLY, any unit: "
     "normalised by its own volume, centroid and axes); or built-in `\"sphere\"`, `\"ellipsoid:1:0.8:0.6\"`, "
     "`\"superellipsoid:1:0.8:0.6:0.5\"` (exponent, or two), `\"box:1:1:2\"` (ratios)"},
    {"grains.sample", "", "none",
     "instead of `shapes`: a new grain for every place, its code drawn from those of a "
     "category, see [Grains made for the case](#grains-made-for-the-case)"},
    {"grains.sample.library", "", "", "the library's word"},
    {"grains.sample.category", "", "", "what stands before the last slash of its shapes' names"},
    {"grains.sample.truncate", "(0, inf)", "", "the Gaussian of the codes is cut here [standard deviations]"},
    {"grains.sample.sphericity", "", "any", "Wadell's, of what is taken; within 0 and 1, like the next four"},
    {"grains.sample.convexity", "", "any", "volume over that of the hull"},
    {"grains.sample.elongation", "", "any", "EI = b/a"},
    {"grains.sample.flatness", "", "any", "FI = c/b"},
    {"grains.sample.roundness", "", "any", "corner radii over the inscribed radius"},
    {"grains.interpolate", "", "none", "instead of `shapes`: grains between two codes"},
    {"grains.interpolate.library", "", "", "the library's word"},
    {"grains.interpolate.from", "", "", "name of a shape of one decoder, t = 0"},
    {"grains.interpolate.to", "", "", "... and of another, t = 1"},
    {"grains.interpolate.t", "[0, 1]", "required",
     "a number: all grains alike; [low, high]: spread evenly over the grains; `\"random\"`: drawn for every grain"},
    {"grains.evaluator", "", "",
     "what answers for phi. `\"net\"`: what the shape is stored as (network, harmonics, mesh, grid or formula); "
     "`\"grid\"`: "
     "baked to a trilinear grid; `\"mesh\"`: its zero set triangulated, or the stored mesh; `\"analytic\"`: as stored, "
     "formulas and harmonics only"},
    {"grains.grid_cells", "[8, 256]", "", "cells across the bounding diameter, beside `\"grid\"`"},
    {"grains.mesh_cells", "[8, 128]", "", "... beside `\"mesh\"`"},
    {"grains.nodes", "[32, 1e6]", "", "surface nodes a grain, or `\"fast\"` = 1000"},
    {"grains.storage", "", "",
     "`\"compact\"`: a shape run as a network keeps 16-bit radii along shared directions instead of node arrays, 2.8 "
     "kB a "
     "shape at 1,000 nodes; `nodes` then counts uniform directions, at most 20,000; a body that is not star-shaped "
     "keeps "
     "arrays, with a note"},
    {"grains.count", "[0, 1e8]", "required; list, file: the number of positions", "number of grains"},
    {"grains.diameter", "(0, inf)", "required",
     "of the equal-volume sphere [m]; or `[least, largest]`: drawn uniformly for "
     "each grain"},
    {"grains.apart", "", "",
     "`true`: grains of this entry meet walls and grains of their own entry only, so that several "
     "entries can start at the same places in one run"},
    {"grains.insert", "", "", "how they get in"},
    {"grains.insert.kind", "", "",
     "`\"lattice\"`: cells of a cubic lattice, filled from the bottom; `\"random\"`: all at the start, bounding "
     "spheres clear "
     "of each other, of walls and of other grains (up to about 30 % by volume); `\"rate\"`: one after the other, as "
     "`\"random\"`; `\"list\"`: at given places; `\"file\"`: at places from a table"},
    {"grains.insert.box", "", "", "two corners, the second above the first on every axis [m]"},
    {"grains.insert.rate", "(0, inf)", "",
     "grains a second. A grain that finds no free place in 100 random tries is tried "
     "again at every step; the log says when insertion is blocked and what did not get in"},
    {"grains.insert.start", "[0, inf)", "", "... from this time on [s]"},
    {"grains.insert.file", "", "",
     "comma-separated values, columns named by the first line: `x,y,z` [m], and, if given, `qw,qx,qy,qz`, `vx,vy,vz` "
     "[m/s], `wx,wy,wz` [rad/s], `shape` (index into `shapes`, from 0, patterns written out in the order of their "
     "library)"},
    {"grains.insert.position", "", "", "a position a grain [m]"},
    {"grains.insert.quaternion", "", "by `orientation`", "(w, x, y, z) body to world, one a position"},
    {"grains.insert.orientation", "", "", "`\"aligned\"`: body axes along the world's"},
    {"grains.insert.velocity", "", "", "[m/s]"},
    {"grains.insert.spin", "", "", "[rad/s]"},
    {"grains.insert.scatter", "", "",
     "list, file only: every grain starts anywhere within +- this of its position, drawn "
     "with the seed [m]"},

    {"wall", "", "none", "planes, containers and other bodies of infinite mass"},
    {"wall.name", "", "", "of this entry"},
    {"wall.material", "", "", "name of a `[[material]]`"},
    {"wall.kind", "", "",
     "`\"mesh\"`: STL, OBJ or PLY; `\"terrain\"`: ESRI ASCII grid (x, y from its lower left corner), solid "
     "straight below its surface and nothing beside it, cells without data are holes"},
    {"wall.side", "", "", "where the grains are (mesh: of a closed one); `\"outside\"`: it is a solid"},
    {"wall.point", "", "", "[m]"},
    {"wall.normal", "", "", "points into the free space, any length"},
    {"wall.min", "", "", "corner [m]"},
    {"wall.max", "", "", "corner, above `min` on every axis [m]"},
    {"wall.from", "", "", "end of the axis [m]"},
    {"wall.to", "", "", "the other end [m]"},
    {"wall.radius", "(0, inf)", "", "[m]"},
    {"wall.radius_from", "[0, inf)", "", "of the middle of the wall of a shell with round rims at `from` [m] ..."},
    {"wall.radius_to", "[0, inf)", "", "... and at `to` [m]; not both 0"},
    {"wall.thickness", "", "required by cone; mesh: closed",
     "cone: of the shell, > 0; mesh: an open surface this thick, solid half of it on both sides; without it the mesh "
     "must "
     "be closed [m]"},
    {"wall.open", "", "",
     "faces left out, inside only: of a box `\"-x\" \"+x\" \"-y\" \"+y\" \"-z\" \"+z\"`, of a cylinder "
     "`\"from\" \"to\"`"},
    {"wall.file", "", "", "mesh or terrain"},
    {"wall.scale", "(0, inf)", "", "metres a unit of the file ..."},
    {"wall.shift", "", "", "... then moved by [m]"},
    {"wall.motion", "", "at rest", "constant, or a table that is linear between its times. Of no rate: at rest"},
    {"wall.motion.kind", "", "", "about a fixed axis, or without turning"},
    {"wall.motion.axis", "", "", "right-handed about it, any length"},
    {"wall.motion.through", "", "", "a point of the axis [m]"},
    {"wall.motion.rate", "", "required without `time`", "[rad/s]"},
    {"wall.motion.velocity", "", "required without `time`", "[m/s]"},
    {"wall.motion.start", "[0, inf)", "", "moves from [s] ..."},
    {"wall.motion.end", "", "for ever", "... to [s]"},
    {"wall.motion.time", "", "constant motion",
     "of a table, ascending [s]; instead of `rate` or `velocity`, `start` and `end`"},
    {"wall.motion.rates", "", "", "at these times [rad/s]"},
    {"wall.motion.velocities", "", "", "at these times [m/s]"},

    {"measure", "", "nothing is measured", "which kind takes which keys: [Measurements](#measurements)"},
    {"measure.name", "", "", "of this entry"},
    {"measure.kind", "", "", "what is measured, see [Measurements](#measurements)"},
    {"measure.every", "(0, inf)", "`output.every`", "time between samples [s]"},
    {"measure.from", "", "", "samples from here [s] ..."},
    {"measure.until", "", "the end", "... to here enter mean and spread [s]"},
    {"measure.box", "", "by kind", "region: two corners [m]; or"},
    {"measure.cylinder", "", "by kind", "region"},
    {"measure.cylinder.from", "", "", "end of its axis [m]"},
    {"measure.cylinder.to", "", "", "the other end [m]"},
    {"measure.cylinder.radius", "(0, inf)", "", "[m]"},
    {"measure.slices", "[0, 1000]", "", "equal slices along z (cylinder: its axis), 0 the lowest"},
    {"measure.points", "[100, 1e6]", "", "of the quasi-random set that measures cut grains, a shape"},
    {"measure.wall", "", "by kind", "name of a `[[wall]]`"},
    {"measure.grains", "", "all; trajectory: required", "name of a `[[grains]]` entry"},
    {"measure.delete", "", "by kind", "name of a `[[delete]]`"},
    {"measure.axis", "", "by kind", "any length"},
    {"measure.through", "", "by kind", "a point of the axis [m]"},
    {"measure.direction", "", "by kind", "any length"},
    {"measure.point", "", "by kind", "a point of the plane [m]"},
    {"measure.normal", "", "by kind", "of the plane, points to where grains go, any length"},
    {"measure.radius", "(0, inf)", "by kind", "[m]"},
    {"measure.bin", "(0, inf)", "largest d", "width of the cells whose highest grain counts [m]"},
    {"measure.flank", "", "", "shares of a heap's height between which its flank lies"},
    {"measure.longer_than", "(0, inf)", "", "[s]"},
    {"measure.above", "(0, inf)", "", "[mean contact force]"},
    {"measure.contacts", "", "",
     "all contacts of each sample, walls too, to `contacts.csv` (a, b: bodies, wall w of the case "
     "as -1 - w; point [m]; force on a [N])"},
    {"measure.index", "", "all", "of grains in their entry, counted from 0"},

    {"relax", "", "grains start where they are put", "before time runs, grains that overlap are pushed apart"},
    {"relax.overlap", "(0, 0.5]", "",
     "until no contact is deeper than this [d]; what was stored in them is said and gone"},
    {"relax.travel", "(0, 0.1]", "", "furthest way of any point in one pass [d]"},
    {"relax.passes", "[1, 1e6]", "", "where more are needed there is no room, and the case is refused"},

    {"device", "", "fp32", "how networks on a GPU compute, see [Precision](#precision)"},
    {"device.precision", "", "",
     "`\"fp32\"`: the CPU's bits; `\"fp16x3\"`: tensor cores, within 1e-6 d of it; `\"fast\"`: one pass in half "
     "precision. The CPU "
     "computes in fp32 and says so"},

    {"output", "", "", "what is written"},
    {"output.every", "(0, inf)", "", "time between frames [s]"},
    {"output.paraview", "", "", "also write `paraview/` while running"},

    {"checkpoint", "", "none",
     "in `checkpoint/` of the output folder; `scree run case.toml --resume` goes on from the newest"},
    {"checkpoint.every", "(0, inf)", "", "time between checkpoints [s]"},
    {"checkpoint.keep", "[1, 1000]", "", "how many are kept"},

    {"limits", "", "", "what stops a run, and which networks may run"},
    {"limits.overlap", "(0, 0.5]", "", "the watch stops the run above this overlap [d]"},
    {"limits.ledger", "(0, inf)", "", "allowed share of the energy moved that the ledger cannot account for"},
    {"limits.gradient", "", "", "allowed \\|grad phi\\| of a shape's certificate (1st, 99th percentile), around 1"},
    {"limits.components", "[0, inf)", "", "pieces of the zero set, voids inside counted"},
    {"limits.handles", "[0, inf)", "", "holes through the body"},
    {"limits.falling", "[0, inf)", "",
     "share of the interior in which phi falls inwards: deep overlaps would lose force"},
    {"limits.gap", "[0, inf)", "", "largest blind gap between the certificate's surface nodes [d]; if measured"},
    {"limits.mae", "[0, inf)", "", "mean error of phi [d]; if measured"},
    {"limits.hausdorff", "[0, inf)", "", "largest distance of the surface from the source [d]; if measured"},
    {"limits.volume", "[0, inf)", "", "relative error of the volume before normalisation; if measured"},
    {"limits.inertia", "[0, inf)", "", "relative error of the inertia before normalisation; if measured"},
};

bool is_index(std::string_view word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Span<CaseKey const> case_keys() { return {table, static_cast<int>(std::size(table))}; }

std::string without_indices(std::string const& path) {
  std::string out;
  for (std::size_t begin = 0; begin <= path.size();) {
    std::size_t const end = std::min(path.find('.', begin), path.size());
    std::string_view const word = std::string_view(path).substr(begin, end - begin);
    if (!is_index(word)) out.append(out.empty() ? "" : ".").append(word);
    begin = end + 1;
  }
  return out;
}

CaseKey const* find_case_key(std::string const& path) {
  static auto const rows = [] {
    std::unordered_map<std::string, CaseKey const*> map;
    for (CaseKey const& k : table) map.emplace(k.path, &k);
    return map;
  }();
  auto const found = rows.find(without_indices(path));
  return found == rows.end() ? nullptr : found->second;
}

}  // namespace scree
