// entries.cpp: see entries.h: what several entries use.
// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/entries.h"

namespace scree::book {

std::string evaluator_name(Evaluator evaluator) {
  switch (evaluator) {
    case Evaluator::net:
      return "as stored";
    case Evaluator::grid:
      return "grid";
    case Evaluator::mesh:
      return "mesh";
    case Evaluator::analytic:
      return "formula";
  }
  return "?";
}

}  // namespace scree::book
