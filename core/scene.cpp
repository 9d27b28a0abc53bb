// scene.cpp: materials, walls and bodies of a scene. See scene.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/scene.h"

#include <algorithm>

#include "core/grain_entries.h"
#include "core/placement.h"
#include "core/scene_shapes.h"
#include "core/wall_bodies.h"
#include "kernels/contact_laws.h"
#include "kernels/restitution.h"

namespace scree {

SceneView Scene::view() const {
  SceneView v;
  v.shape = shape;
  v.nodes.position = node_position;
  v.nodes.area = node_area;
  v.nodes.block_centre = block_centre;
  v.nodes.block_radius = block_radius;
  v.nodes.block_first = block_first;
  compact.fill(v.nodes);
  v.sdf = {coefficient, grid_value, mesh_node, mesh_corner, mesh_normal};
  v.shape_of = shape_of;
  v.material_of = material_of;
  v.world_of = world_of;
  v.diameter = diameter;
  v.mass = mass;
  v.inertia = inertia;
  v.plane = plane;
  v.contact = contact;
  v.walls = static_cast<int>(wall.size());
  v.materials = static_cast<int>(material.size());
  v.friction = friction;
  v.cohesion_reach = cohesion_reach;
  v.cohesion_margin = cohesion_margin;
  return v;
}

namespace {

// Below this overlap Hertz's pressure is a straight line [d of the largest grain]: p' would be infinite at touch.
double constexpr hertz_onset = 1e-4;

PressureLaw normal_law(ContactCase const& contact, double d) {
  PressureLaw law;
  law.kind = contact.law;
  law.reference = contact.at_overlap * d;
  switch (contact.law) {
    case ContactLaw::winkler:
      law.modulus = contact.kappa ? *contact.kappa : winkler_modulus(contact.stiffness, d, contact.at_overlap * d);
      return law;
    case ContactLaw::linear:
      law.modulus = linear_modulus(contact.stiffness, d);
      law.onset = contact.onset * d;
      return law;
    case ContactLaw::hertz:
      law.modulus = hertz_modulus(contact.youngs_modulus, contact.poisson_ratio);
      law.onset = hertz_onset * d;
      return law;
  }
  throw std::invalid_argument("this ContactLaw does not exist");
}

ContactParameters parameters_of(ContactCase const& contact, double largest_diameter) {
  ContactParameters p;
  ContactLaw const law = contact.law;
  p.normal = normal_law(contact, largest_diameter);
  p.tangential = contact.tangential_ratio;
  p.friction = contact.friction.value_or(0);
  if (contact.cohesion && contact.cohesion->traction > 0 && contact.cohesion->range > 0)
    p.cohesion = {contact.cohesion->traction, contact.cohesion->range};
  if (contact.rolling) {
    p.rolling = contact.rolling->friction;
    p.rolling_ratio = contact.rolling->stiffness_ratio;
    p.rolling_damping = contact.rolling->damping;
  }
  if (contact.damping_ratio) {
    p.damping_nodes = *contact.damping_ratio;
    // Both paths have to rebound alike, so the ratio stands for the restitution it gives on nodes.
    p.damping_sphere = p.damping_nodes > 0 ? damping_ratio_for(restitution_of(p.damping_nodes, DampingPath::nodes, law),
                                                               DampingPath::sphere, law)
                                           : 0;
  } else if (contact.restitution) {
    p.damping_nodes = damping_ratio_for(*contact.restitution, DampingPath::nodes, law);
    p.damping_sphere = damping_ratio_for(*contact.restitution, DampingPath::sphere, law);
  }
  return p;
}

void build_contacts(Case const& c, Scene& scene, std::vector<std::string>& found) {
  int const n = static_cast<int>(c.material.size());
  double largest = 0;
  for (GrainsCase const& g : c.grains) largest = std::max(largest, g.diameter);
  for (MaterialCase const& m : c.material) scene.material.push_back(m.name);
  scene.contact.assign(std::size_t(n) * n, {});
  for (ContactCase const& contact : c.contact) {
    int const a = material_index(c, contact.pair.first), b = material_index(c, contact.pair.second);
    if (a < 0 || b < 0) continue;
    try {
      ContactParameters const p = parameters_of(contact, largest);
      for (int k : {a * n + b, b * n + a}) scene.contact[k] = p;
    } catch (std::invalid_argument const& e) {
      found.push_back("contact '" + contact.pair.first + "' - '" + contact.pair.second + "': " + e.what());
    }
  }
  for (ContactParameters const& p : scene.contact) {
    scene.friction = scene.friction || p.friction > 0;
    scene.rolling = scene.rolling || p.rolling > 0;
    scene.cohesion_reach = std::max(scene.cohesion_reach, p.cohesion.reach());
  }
  // Of shapes that the gate lets pass, |grad phi| is not far below limits.gradient's lower end.
  scene.cohesion_margin = scene.cohesion_reach / std::min(1.0, c.limits.gradient_low);
}

void add_bodies(Case const& c, std::vector<GrainEntry> const& entries, std::vector<std::vector<int>> const& templates,
                Scene& scene) {
  bool const worlds = has_worlds(entries);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    GrainsCase const& grains = c.grains[entries[e].group];
    int const material = material_index(c, grains.material);
    double const density = c.material[material].density, least = grains.least_diameter.value_or(grains.diameter);
    std::mt19937_64 random = random_stream(entries[e].seed, entries[e].group, Draw::sizes);
    for (int shape : assign_shapes(c, entries[e], templates[e])) {
      Shape const s = scene.template_shape(shape);
      scene.shape_of.push_back(shape);
      scene.material_of.push_back(material);
      scene.group_of.push_back(entries[e].group);
      if (worlds) scene.world_of.push_back(entries[e].world);
      double const d = grains.least_diameter ? least + (grains.diameter - least) * uniform(random) : grains.diameter;
      scene.diameter.push_back(d);
      scene.mass.push_back(density * s.volume * d * d * d);
      scene.inertia.push_back(s.inertia * (density * d * d * d * d * d));
    }
  }
}

// Templates of each entry, as one replica's entries name them; what is drawn at random is drawn for every replica.
void make_templates(Case const& c, std::vector<GrainEntry> const& entries, int threads, ShapeCatalogue& catalogue,
                    Scene& scene, std::vector<std::vector<int>>& templates, std::vector<std::string>& found) {
  std::size_t const groups = c.grains.size();
  for (std::size_t e = 0; e < entries.size(); ++e) {
    GrainsCase const& grains = c.grains[entries[e].group];
    bool const random = grains.sample || (grains.interpolate && grains.interpolate->random);
    if (random || (grains.interpolate && e < groups))
      templates[e] = catalogue.make_templates(grains, entries[e].group, entries[e].seed, scene, threads, found);
    else if (e >= groups)
      templates[e] = templates[entries[e].group];
  }
}

}  // namespace

Scene build_scene(Case const& c, int threads, Placement& placement) {
  std::vector<std::string> found = problems(c);
  if (!found.empty()) throw InputError(found);
  Scene scene;
  build_contacts(c, scene, found);
  ShapeCatalogue catalogue(c, found);
  std::vector<GrainEntry> const entries = entries_of(c);
  std::vector<std::vector<int>> templates;
  for (GrainsCase const& grains : c.grains) templates.push_back(catalogue.templates_for(grains, scene, found));
  if (!found.empty()) throw InputError(found);
  templates.resize(entries.size());
  make_templates(c, entries, threads, catalogue, scene, templates, found);
  for (std::size_t g = 0; g < c.grains.size(); ++g)
    for (int const shape : c.grains[g].insert.shape)
      if (shape >= static_cast<int>(templates[g].size())) {
        found.push_back("grains '" + c.grains[g].name + "': insert.file asks for shape " + std::to_string(shape) +
                        ", but `shapes` names " + std::to_string(templates[g].size()) + " (0 is the first)");
        break;
      }
  if (!found.empty()) throw InputError(found);
  std::vector<WallSolid> const walls = build_walls(c, scene, found);
  bool const sphere_nodes = std::any_of(walls.begin(), walls.end(),
                                        [](WallSolid const& w) { return !meets_spheres_in_closed_form(w.record); });
  catalogue.finish(scene, templates, sphere_nodes, threads, found);
  add_bodies(c, entries, templates, scene);
  add_wall_bodies(c, walls, scene);
  placement = place_grains(c, scene, found);
  if (!found.empty()) throw InputError(found);
  return scene;
}

}  // namespace scree
