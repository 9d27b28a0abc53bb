// impulse_error.h: what a time step costs the impulse of a contact.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/contact_laws.h"

namespace scree {

// n of F ~ overlap^n between smooth bodies. Throws std::invalid_argument for a law that does not exist.
double force_exponent(ContactLaw law);

// Largest error of the impulse of a head-on contact, as a share of it, when the step is `safety` of the critical one at
// its deepest overlap: velocity Verlet, whatever part of a step before touch it begins. Of a pressure law between
// smooth bodies: winkler F ~ x^2, hertz x^1.5, linear x. Never less than for a smaller step.
double impulse_error(ContactLaw law, double safety);

}  // namespace scree
