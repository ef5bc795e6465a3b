#pragma once

// Renders an imported scene with an integrator such as albedo or normals, for tests of the import.

#include <atomic>

#include "renderlib/import/import.h"
#include "renderlib/render/render_image.h"

namespace bandsaw::test {

/// Renders one sample per pixel by the integrator; `imported` MUST have a scene.
inline Image layer(const ImportedScene& imported, std::uint32_t width, std::uint32_t height,
                   Integrator integrator) {
  Pool pool(1);
  const auto scene = Scene::build(imported.scene, pool).value();
  RenderSettings settings{.width = width, .height = height};
  settings.integrator = integrator;
  const std::atomic<bool> stop{false};
  return render_image(*scene, settings, 1, pool, stop, {}, "").value().film.snapshot().image;
}

}  // namespace bandsaw::test
