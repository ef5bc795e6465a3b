// An example of a program that uses the installed library. Renders a ball under a sky and writes
// ball.pfm. CMakeLists.txt finds the library with find_package(bandsaw).
#include <renderlib/image/write_image.h>
#include <renderlib/render/render_image.h>

int main() {
  using namespace bandsaw;
  SceneDescription ball{.camera = PerspectiveCamera{.position = {0, 1, 4}, .look_at = {0, 0, 0}},
                        .background = {{0.5F, 0.7F, 1}, {0.5F, 0.7F, 1}}};
  ball.textures = {ConstantTexture{{0.8F, 0.3F, 0.2F}}};
  ball.materials = {Diffuse{TextureId{0}}};
  ball.geometry.spheres = {{{0, 0, 0}, /*radius=*/1, MaterialId{0}}};
  Pool pool(2);
  const auto scene = Scene::build(ball, pool);
  const auto image = render_image(*scene.value(), {.width = 96, .height = 64}, /*samples=*/16, pool,
                                  /*stop=*/false, /*progress=*/{}, /*spill_folder=*/"");
  return write_image(image.value().film.snapshot().image, "ball.pfm").ok() ? 0 : 1;
}
