// Writes the summary of a scene that `bandsaw info` prints, as lines of text and as JSON.

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/scene/scene_summary.h"

namespace bandsaw::coordinator {
namespace {

std::string text(const std::vector<Count>& counts) {
  const auto one = [](std::string* out, const Count& c) {
    absl::StrAppend(out, c.count, " × ", c.what);
  };
  return counts.empty() ? "none" : absl::StrJoin(counts, ", ", one);
}

std::vector<JsonObject> objects(const std::vector<Count>& counts) {
  std::vector<JsonObject> out;
  for (const Count& c : counts) {
    out.push_back(JsonObject().text("what", c.what).whole("count", c.count));
  }
  return out;
}

std::string triple(const Vec3& v) { return absl::StrCat("[", v.x, ", ", v.y, ", ", v.z, "]"); }

std::string bytes(std::uint64_t count) { return si(static_cast<double>(count)) + "B"; }

}  // namespace

std::vector<std::string> summary_text(const SceneSummary& summary) {
  const PackageInfo& info = summary.info;
  const auto line = [](absl::string_view name, absl::string_view value) {
    return absl::StrCat(pad_right(name, 11), value);
  };
  std::vector<std::string> lines = {
      printable(info.name),
      line("image", absl::StrCat(info.width, "×", info.height, ", ", summary.filter,
                                 ", integrator ", integrator_name(info.integrator),
                                 ", paths of at most ", info.max_depth, " surfaces")),
      line("camera", summary.camera),
      line("cameras", info.model_cameras.empty()
                          ? "none in the models of this scene"
                          : absl::StrCat(printable(absl::StrJoin(info.model_cameras, ", ")),
                                         " (--camera NAME)")),
      line("shapes", absl::StrCat(text(summary.shapes), "; ", summary.triangles,
                                  " triangles in all placements")),
      line("bounds",
           summary.bounds.empty()
               ? "none"
               : absl::StrCat(triple(summary.bounds.lo), " to ", triple(summary.bounds.hi),
                              ", size ", triple(summary.bounds.hi - summary.bounds.lo))),
      line("materials", text(summary.materials)),
      line("textures",
           absl::StrCat(text(summary.textures), "; ", bytes(summary.texture_bytes), " of texels")),
      line("lights", absl::StrCat(summary.lights, summary.lights == 1 ? " shape" : " shapes",
                                  " with a material that emits; without size: ",
                                  text(summary.lights_without_size))),
      line("background", summary.background),
      line("media", text(summary.media)),
      line("memory", absl::StrCat(bytes(summary.geometry_bytes), " of geometry, ",
                                  bytes(summary.tree_bytes), " of BVHs, ",
                                  bytes(summary.texture_bytes), " of texels; a pixel takes 48 B")),
      line("size", absl::StrCat(bytes(summary.package_bytes), " to send"))};
  if (info.warnings.empty()) {
    lines.push_back(line("ignored", "nothing"));
  }
  for (const std::string& warning : info.warnings) {
    lines.push_back(line("warning", printable(warning)));
  }
  return lines;
}

std::string summary_json(const SceneSummary& summary) {
  const PackageInfo& info = summary.info;
  JsonObject out;
  out.text("name", info.name)
      .whole("width", info.width)
      .whole("height", info.height)
      .text("integrator", integrator_name(info.integrator))
      .whole("max_depth", info.max_depth)
      .text("filter", summary.filter)
      .text("camera", summary.camera)
      .texts("model_cameras", info.model_cameras)
      .objects("shapes", objects(summary.shapes))
      .whole("triangles", summary.triangles);
  if (!summary.bounds.empty()) {
    const auto corner = [](const Vec3& v) {
      return JsonObject().number("x", v.x).number("y", v.y).number("z", v.z);
    };
    out.objects("bounds", {corner(summary.bounds.lo), corner(summary.bounds.hi)});
  }
  out.objects("materials", objects(summary.materials))
      .objects("textures", objects(summary.textures))
      .whole("texture_bytes", summary.texture_bytes)
      .whole("lights", summary.lights)
      .objects("lights_without_size", objects(summary.lights_without_size))
      .text("background", summary.background)
      .objects("media", objects(summary.media))
      .whole("geometry_bytes", summary.geometry_bytes)
      .whole("tree_bytes", summary.tree_bytes)
      .whole("package_bytes", summary.package_bytes)
      .texts("warnings", info.warnings);
  return out.str();
}

}  // namespace bandsaw::coordinator
