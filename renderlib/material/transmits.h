#pragma once

// Tells whether light can pass through a material. A material through which light can pass cannot
// be one-sided (Material::one_sided).

#include "renderlib/base/overloaded.h"
#include "renderlib/material/material.h"

namespace bandsaw {

/// Returns true if light can pass through the surface from one side to the other. The material MUST
/// NOT be a mixture.
inline bool transmits(const Material& material) {
  return std::visit(
      Overloaded{
          [](const Dielectric&) { return true; }, [](const ThinDielectric&) { return true; },
          [](const DiffuseTransmission&) { return true; },
          [](const MetallicRoughness& m) { return m.transmission.factor > 0; },
          [](const Principled& m) { return m.spec_trans.value > 0; },
          [](const ThinPrincipled& m) { return m.spec_trans.value > 0 || m.diff_trans.value > 0; },
          [](const auto&) { return false; }},
      material.kind);
}

}  // namespace bandsaw
