#include "renderlib/import/scene_file/read_image_texture.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

// One or two finite numbers; one stands for both where `one_for_both`.
absl::StatusOr<Vec2> read_vec2(const Field& in, const std::string& name, const Numbers& list,
                               bool one_for_both, double otherwise) {
  if (list.empty()) {
    return Vec2{otherwise, otherwise};
  }
  if (list.size() > 2 || (list.size() == 1 && !one_for_both)) {
    return in.error(name, absl::StrCat("must be ", one_for_both ? "1 or 2" : "2", " numbers, has ",
                                       list.size()));
  }
  for (int i = 0; i < list.size(); ++i) {
    if (!std::isfinite(list[i])) {
      return in.error(name, absl::StrCat("must be finite, is ", list[i]), i);
    }
  }
  return Vec2{list[0], list[list.size() - 1]};
}

absl::StatusOr<UvTransform> read_uv_transform(const Field& in, const scene::ImageTexture& from) {
  ASSIGN_OR_RETURN(const Vec2 scale, read_vec2(in, "uv_scale", from.uv_scale(), true, 1));
  ASSIGN_OR_RETURN(const Vec2 offset, read_vec2(in, "uv_offset", from.uv_offset(), false, 0));
  if (!std::isfinite(from.uv_rotate())) {
    return in.error("uv_rotate", absl::StrCat("must be finite, is ", from.uv_rotate()));
  }
  const SinCos turn = sincos_degrees(from.uv_rotate());
  return UvTransform{{turn.cos * scale.x, -turn.sin * scale.y, offset.x, turn.sin * scale.x,
                      turn.cos * scale.y, offset.y}};
}

absl::StatusOr<TextureStore::Use> read_use(const Field& in, const scene::ImageTexture& from) {
  using Proto = scene::ImageTexture;
  TextureStore::Use use;
  ASSIGN_OR_RETURN(const auto wrap, read_enum<int>(in, "wrap", from.wrap(), Proto::Wrap_MAX));
  ASSIGN_OR_RETURN(const auto filter,
                   read_enum<int>(in, "filter", from.filter(), Proto::Filter_MAX));
  // Ours count from 0 in the same order, after the file's "not said".
  if (wrap != Proto::WRAP_UNSPECIFIED) {
    use.wrap = static_cast<ImageTexture::Wrap>(wrap - 1);
  }
  ASSIGN_OR_RETURN(const auto wrap_v, read_enum<int>(in, "wrap_v", from.wrap_v(), Proto::Wrap_MAX));
  if (wrap_v != Proto::WRAP_UNSPECIFIED) {
    use.wrap_v = static_cast<ImageTexture::Wrap>(wrap_v - 1);
  }
  if (filter != Proto::FILTER_UNSPECIFIED) {
    use.filter = static_cast<ImageTexture::Filter>(filter - 1);
  }
  ASSIGN_OR_RETURN(const auto encoding,
                   read_enum<int>(in, "encoding", from.encoding(), Proto::Encoding_MAX));
  use.linear = encoding == Proto::ENCODING_LINEAR;
  ASSIGN_OR_RETURN(use.uv_set, read_enum<UvSet>(in, "uv_set", from.uv_set(), scene::UvSet_MAX));
  ASSIGN_OR_RETURN(use.uv_transform, read_uv_transform(in, from));
  return use;
}

}  // namespace

absl::StatusOr<TextureId> read_image_texture(const Field& in, const scene::ImageTexture& from,
                                             SceneDraft& draft) {
  ASSIGN_OR_RETURN(const TextureStore::Use use, read_use(in, from));
  if (from.file().empty()) {
    return in.error("file", "is required: the name of an image file");
  }
  const auto path = draft.folder.resolve(from.file(), draft.folder.path());
  if (!path.ok()) {
    return in.error("file", path.status().message());
  }
  auto texture = draft.textures.image(*path, from.file(), use,
                                      [&] { return read_whole_file(*path, kMaxImageFileBytes); });
  if (!texture.ok()) {
    return in.error("file", texture.status().message());
  }
  return texture;
}

}  // namespace bandsaw
