#include "renderlib/import/scene_file/read_environment.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/environment_image.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_rotation.h"

namespace bandsaw {
namespace {

absl::StatusOr<TextureId> read_image(const Field& in, const std::string& name,
                                     const std::string& file, SceneDraft& draft) {
  if (file.empty()) {
    return in.error(name, "is required: the name of an image file");
  }
  const auto path = draft.folder.resolve(file, draft.folder.path());
  if (!path.ok()) {
    return in.error(name, path.status().message());
  }
  const auto bytes = read_whole_file(*path, kMaxImageFileBytes);
  if (!bytes.ok()) {
    return in.error(name, bytes.status().message());
  }
  auto image = add_environment_image(*bytes, file, draft);
  return image.ok() ? image : in.error(name, image.status().message());
}

template <class Message>
absl::Status read_placement(const Field& in, const Message& from, Environment& to) {
  constexpr double kMaxStrength = 1e6;
  const double strength = from.has_strength() ? from.strength() : 1;
  RETURN_IF_ERROR(check_range(in, "strength", strength, 0, kMaxStrength));
  to.strength = static_cast<float>(strength);
  ASSIGN_OR_RETURN(const Transform turn, read_rotation(in, from.rotate()));
  to.axes = {turn.direction({1, 0, 0}), turn.direction({0, 1, 0}), turn.direction({0, 0, 1})};
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Environment> read_environment(const Field& in, const scene::EnvironmentMap& from,
                                             SceneDraft& draft) {
  Environment to;
  RETURN_IF_ERROR(read_placement(in, from, to));
  ASSIGN_OR_RETURN(const TextureId image, read_image(in, "file", from.file(), draft));
  to.images = {image};
  return to;
}

absl::StatusOr<Environment> read_cube_map(const Field& in, const scene::CubeMap& from,
                                          SceneDraft& draft) {
  Environment to;
  to.kind = Environment::Kind::kCube;
  RETURN_IF_ERROR(read_placement(in, from, to));
  to.axes.x = from.left_handed() ? -to.axes.x : to.axes.x;
  for (const auto& [name, file] :
       {std::pair("positive_x", from.positive_x()), std::pair("negative_x", from.negative_x()),
        std::pair("positive_y", from.positive_y()), std::pair("negative_y", from.negative_y()),
        std::pair("positive_z", from.positive_z()), std::pair("negative_z", from.negative_z())}) {
    ASSIGN_OR_RETURN(const TextureId id, read_image(in, name, file, draft));
    to.images.push_back(id);
    const auto& image = std::get<ImageTexture>(draft.textures[id]);
    const auto& first = std::get<ImageTexture>(draft.textures[to.images.front()]);
    if (image.width != image.height || image.width != first.width) {
      return in.error(name, absl::StrCat("images of a cube map must be square and of one size; \"",
                                         file, "\" is ", image.width, " x ", image.height));
    }
  }
  return to;
}

}  // namespace bandsaw
