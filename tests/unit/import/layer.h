#pragma once

// Renders a layer of an imported scene, for tests of the import. A layer is the image of one
// integrator, such as albedo or normals.

#include <atomic>

#include "renderlib/import/import.h"
#include "renderlib/render/render_image.h"

namespace bandsaw::test {

/// Returns the image of the scene by this integrator, with one sample per pixel. The scene MUST be
/// valid.
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
