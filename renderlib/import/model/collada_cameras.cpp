// Finds the nodes of a COLLADA file that have an instance of a camera, and reads the optics of that
// camera.

#include "renderlib/import/model/collada_cameras.h"

#include <pugixml.hpp>

#include "absl/strings/match.h"
#include "absl/strings/strip.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

// Returns the number in the child element `name`; 0 if there is none, or if it is not above 0.
double number(const pugi::xml_node& in, const char* name) {
  const double value = in.child(name).text().as_double();
  return value > 0 ? value : 0;
}

// Returns a perspective camera's vertical field of view in radians; std::nullopt if the file has no
// angle. The angles in the file are in degrees. xfov is used only if there is no yfov. `aspect` is
// width / height.
std::optional<double> vertical_fov(const pugi::xml_node& perspective, double aspect) {
  const double vertical = number(perspective, "yfov");
  const double horizontal = number(perspective, "xfov");
  if (vertical > 0 || horizontal == 0) {
    return vertical > 0 ? std::optional(vertical * kPi / 180) : std::nullopt;
  }
  const SinCos half = sincos_turns(horizontal / 720);  // sine and cosine of half the angle
  return 2 * atan2(half.sin, half.cos * aspect);
}

// Returns the whole height of an orthographic camera; std::nullopt if the file has none. ymag and
// xmag are half of the height and half of the width. xmag is used only if there is no ymag.
// `aspect` is width / height.
std::optional<double> height(const pugi::xml_node& orthographic, double aspect) {
  const double vertical = number(orthographic, "ymag");
  const double half = vertical > 0 ? vertical : number(orthographic, "xmag") / aspect;
  return half > 0 ? std::optional(2 * half) : std::nullopt;
}

// Returns the lens of a <camera>. The lens is empty if the camera has no valid size or angle. If
// the file has no aspect ratio, the ratio is 1.
ColladaLens lens_of(const pugi::xml_node& camera) {
  const pugi::xml_node common = camera.child("optics").child("technique_common");
  const auto aspect = [](const pugi::xml_node& in) {
    const double ratio = number(in, "aspect_ratio");
    return ratio > 0 ? ratio : 1;
  };
  ColladaLens lens;
  if (const pugi::xml_node flat = common.child("orthographic")) {
    lens.height = height(flat, aspect(flat));
  } else if (const pugi::xml_node perspective = common.child("perspective")) {
    lens.vertical_fov = vertical_fov(perspective, aspect(perspective));
  }
  return lens;
}

}  // namespace

bool is_collada(absl::string_view path) { return absl::EndsWithIgnoreCase(path, ".dae"); }

ColladaLenses read_collada_lenses(absl::string_view text) {
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size());
  std::map<std::string, ColladaLens> by_id;
  for (const auto& found : document.select_nodes("/COLLADA/library_cameras/camera")) {
    by_id[found.node().attribute("id").value()] = lens_of(found.node());
  }
  ColladaLenses lenses;
  for (const auto& found : document.select_nodes("//node/instance_camera")) {
    const pugi::xml_node node = found.node().parent();
    const std::string id = node.attribute("id").value();
    const absl::string_view url = found.node().attribute("url").value();
    const ColladaLens lens = by_id[std::string(absl::StripPrefix(url, "#"))];
    if (lens.vertical_fov || lens.height) {
      lenses.try_emplace(id.empty() ? node.attribute("sid").value() : id, lens);
    }
  }
  return lenses;
}

}  // namespace bandsaw
