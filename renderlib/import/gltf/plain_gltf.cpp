// Rewrites a glTF file as a plain document, which any reader understands. Rewriter goes through the
// lists of the JSON. It writes plain copies of the arrays of meshes and skins, and of the images
// that are not files, to one new buffer, and makes the document refer to these copies.

#include "renderlib/import/gltf/plain_gltf.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/gltf/gltf_accessor.h"
#include "renderlib/import/gltf/gltf_animation.h"
#include "renderlib/import/gltf/gltf_file.h"
#include "renderlib/import/gltf/gltf_references.h"
#include "renderlib/import/gltf/plain_meshes.h"

namespace bandsaw::gltf {
namespace {

/// Extensions that replace the bytes of vertices or images, and that are not read. A file that uses
/// but does not require them has a fallback.
constexpr absl::string_view kUnreadable[] = {"KHR_meshopt_compression", "KHR_texture_basisu",
                                             "EXT_texture_avif", "MSFT_texture_dds"};
constexpr char kWebp[] = "EXT_texture_webp";

/// Returns INVALID_ARGUMENT if the file requires one of kUnreadable.
absl::Status check_required(const Json& root) {
  for (const Json& required : items(root, "extensionsRequired")) {
    const std::string name = required.is_string() ? required.get<std::string>() : "";
    if (std::find(std::begin(kUnreadable), std::end(kUnreadable), name) != std::end(kUnreadable)) {
      return absl::InvalidArgumentError(
          absl::StrCat("it requires the extension ", name,
                       ", which is not read; convert it to a file without that extension, with "
                       "`gltf-transform copy`, `gltf-transform ktxdecompress` or "
                       "`gltf-transform webp`"));
    }
  }
  return absl::OkStatus();
}

bool has_targets(const Json& mesh) {
  const Json& primitives = items(mesh, "primitives");
  return std::any_of(primitives.begin(), primitives.end(),
                     [](const Json& primitive) { return !items(primitive, "targets").empty(); });
}

/// Makes the plain document of one file.
class Rewriter {
 public:
  Rewriter(const GltfFile& file, Buffers& buffers)
      : from_(file.root), buffers_(buffers), meshes_(file.root, buffers, out_) {}

  /// Returns the plain document, with the animation that `choice` names. May be called once.
  absl::StatusOr<PlainGltf> run(const AnimationChoice& choice) {
    plain_.root = from_;
    plain_.animation_names = animation_names(from_);
    ASSIGN_OR_RETURN(const auto chosen, choose(choice, plain_.animation_names));
    if (chosen) {
      ASSIGN_OR_RETURN(plain_.animation, read_animation(from_, *chosen, buffers_));
    }
    for (const char* name :
         {"animations", "accessors", "bufferViews", "buffers", "extensionsRequired"}) {
      plain_.root.erase(name);
    }
    for (std::size_t i = 0; i < items(from_, "meshes").size(); ++i) {
      ASSIGN_OR_RETURN(plain_.root["meshes"][i], meshes_.mesh(i));
    }
    for (std::size_t i = 0; i < items(from_, "skins").size(); ++i) {
      RETURN_IF_ERROR(rewrite_skin(i));
    }
    RETURN_IF_ERROR(check_joints());
    separate_poses();
    RETURN_IF_ERROR(rewrite_textures());
    plain_.buffer = out_.finish(kPlainBuffer, plain_.root);
    return std::move(plain_);
  }

 private:
  /// Copies the inverse bind matrices of a skin to the buffer. A skin without matrices gets
  /// identity matrices (glTF 2.0, 3.7.3.1).
  absl::Status rewrite_skin(std::size_t index) {
    const std::string place = absl::StrCat("skins[", index, "]");
    const Json& skin = from_["skins"][index];
    const std::size_t joints = items(skin, "joints").size();
    std::vector<float> matrices;
    if (find(skin, "inverseBindMatrices") == nullptr) {
      constexpr float kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      for (std::size_t j = 0; j < joints; ++j) {
        matrices.insert(matrices.end(), std::begin(kIdentity), std::end(kIdentity));
      }
    } else {
      ASSIGN_OR_RETURN(const std::size_t accessor, whole_of(skin, "inverseBindMatrices", place));
      ASSIGN_OR_RETURN(const AccessorShape shape, accessor_shape(from_, accessor, place));
      if (shape.components != 16 || shape.component != Component::kFloat || shape.count < joints) {
        return damaged(shape.place, absl::StrCat("must hold a MAT4 of floats for each of the ",
                                                 joints, " joints of ", place));
      }
      ASSIGN_OR_RETURN(matrices, read_floats(from_, accessor, shape, buffers_));
    }
    plain_.root["skins"][index]["inverseBindMatrices"] = out_.add(matrices, 16);
    return absl::OkStatus();
  }

  /// Checks that the vertices of each node's mesh refer only to joints of the node's skin.
  absl::Status check_joints() const {
    const Json& nodes = items(from_, "nodes");
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Json* skin = item_of(from_, "skins", nodes[n], "skin");
      const auto mesh = number(nodes[n], "mesh");
      const std::size_t joints = skin == nullptr ? 0 : items(*skin, "joints").size();
      const std::uint32_t used = mesh ? meshes_.joints_of(static_cast<std::size_t>(*mesh)) : 0;
      if (skin != nullptr && used > joints) {
        return damaged(absl::StrCat("nodes[", n, "].skin"),
                       absl::StrCat("has ", joints, " joints, but its mesh uses joint ", used - 1));
      }
    }
    return absl::OkStatus();
  }

  /// Returns a value by which the poses of a mesh at different nodes are compared: the skin, and
  /// the weights of morph targets. If the animation changes the weights at this node, the value
  /// also contains the node, because no other node shares these weights.
  Json pose_at(std::size_t node, const Json& mesh) const {
    const Json& from = from_["nodes"][node];
    const Json* skin = find(from, "skin");
    Json pose = {{"skin", skin == nullptr ? Json() : *skin}};
    if (has_targets(mesh)) {
      const Json* own = list(from, "weights");
      pose["weights"] = own == nullptr ? items(mesh, "weights") : *own;
      const bool is_animated = plain_.animation && plain_.animation->weights.count(node) > 0;
      pose["animated"] = is_animated ? Json(node) : Json();
    }
    return pose;
  }

  /// Gives each mesh a single pose: if nodes use a mesh in several poses, each pose after the first
  /// gets a copy of the mesh. The copies share the accessors.
  void separate_poses() {
    // Index of the mesh in the document, keyed by its index in the file and by the pose.
    std::map<std::pair<std::size_t, Json>, std::size_t> posed;
    std::set<std::size_t> used;  // meshes whose first pose is known
    for (std::size_t n = 0; n < items(from_, "nodes").size(); ++n) {
      const auto number_in_file = number(from_["nodes"][n], "mesh");
      if (!number_in_file) {
        continue;
      }
      const auto index = static_cast<std::size_t>(*number_in_file);
      const Json& mesh = from_["meshes"][index];
      const Json pose = pose_at(n, mesh);
      Json& meshes = plain_.root["meshes"];
      const auto [found, is_new] = posed.emplace(std::pair(index, pose), index);
      if (is_new && !used.insert(index).second) {
        found->second = meshes.size();
        meshes.push_back(Json(meshes[index]));
      }
      if (is_new && has_targets(mesh)) {
        meshes[found->second]["weights"] = pose["weights"];
      }
      plain_.root["nodes"][n]["mesh"] = found->second;
    }
  }

  /// Makes the WebP image of a texture its only image, and rewrites the images that are used.
  absl::Status rewrite_textures() {
    std::vector<bool> used(items(from_, "images").size(), false);
    const Json& textures = items(from_, "textures");
    for (std::size_t i = 0; i < textures.size(); ++i) {
      Json& texture = plain_.root["textures"][i];
      if (const Json* webp = extension(textures[i], kWebp)) {
        ASSIGN_OR_RETURN(const std::size_t source,
                         whole_of(*webp, "source", absl::StrCat("textures[", i, "].", kWebp)));
        if (source >= used.size()) {
          return damaged(absl::StrCat("textures[", i, "].", kWebp),
                         absl::StrCat("images[", source, "] does not exist"));
        }
        texture["source"] = source;
        remove_extension(texture, kWebp);
      }
      if (const auto source = number(texture, "source")) {
        used[static_cast<std::size_t>(*source)] = true;
      }
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      RETURN_IF_ERROR(rewrite_image(i, used[i]));
    }
    return absl::OkStatus();
  }

  /// Copies the bytes of a used image to the buffer, unless the image is a file of its own.
  absl::Status rewrite_image(std::size_t index, bool is_used) {
    const std::string place = absl::StrCat("images[", index, "]");
    const Json& from = from_["images"][index];
    const std::string uri = text(from, "uri");
    Json& to = plain_.root["images"][index];
    if (!is_used) {
      // The image stays in the list, with a name that is never opened, so that the other images
      // keep their numbers.
      to = {{"uri", "unused"}};
    } else if (find(from, "bufferView") != nullptr) {
      ASSIGN_OR_RETURN(const std::size_t view, whole_of(from, "bufferView", place));
      ASSIGN_OR_RETURN(const absl::string_view bytes, buffers_.view(view, place));
      embed(bytes, to);
    } else if (absl::StartsWithIgnoreCase(uri, "data:")) {
      const auto bytes = data_of_uri(uri);
      if (!bytes) {
        return damaged(place + ".uri", "its base64 is broken");
      }
      embed(*bytes, to);
    } else if (uri.empty()) {
      return damaged(place, "has neither a uri nor a bufferView");
    }
    return absl::OkStatus();
  }

  /// Adds the bytes of an image to the buffer. The MIME type is only a placeholder: the format of
  /// an image is detected from its bytes.
  void embed(absl::string_view bytes, Json& image) {
    image = {{"bufferView", out_.add_bytes(bytes)}, {"mimeType", "image/png"}};
  }

  const Json& from_;
  Buffers& buffers_;
  PlainBuffer out_;
  PlainMeshes meshes_;
  PlainGltf plain_;
};

}  // namespace

absl::StatusOr<PlainGltf> read_plain_gltf(const std::string& path, const SceneFolder& scene,
                                          const AnimationChoice& choice) {
  GltfFile file;
  ASSIGN_OR_RETURN(const bool is_second, read_gltf_file(path, file));
  if (!is_second) {
    PlainGltf first;
    first.is_first_version = true;
    first.root = std::move(file.root);
    return first;
  }
  RETURN_IF_ERROR(check_required(file.root));
  RETURN_IF_ERROR(check_references(file.root));
  Buffers buffers(file, scene, folder_of(path));
  return Rewriter(file, buffers).run(choice);
}

}  // namespace bandsaw::gltf
