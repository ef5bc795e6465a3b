// The tables of the phone study, another author's study of ray tracing on phones (phone_study.h).
// Each row has the name of an image and its label. A plotted row also has its x in the plot. If the
// study states the image's time, the time in milliseconds is last.

#include "tests/bench/phone_study.h"

#include <algorithm>
#include <array>

namespace bandsaw::coordinator {
namespace {

constexpr std::array kTextureSizes = {
    PhoneRow{"texture_512", "512", 512}, PhoneRow{"texture_1024", "1024", 1024},
    PhoneRow{"texture_2048", "2048", 2048}, PhoneRow{"texture_4096", "4096", 4096}};
constexpr std::array kObjects = {
    PhoneRow{"objects_1", "1", 1, 290}, PhoneRow{"objects_3", "3", 3},
    PhoneRow{"objects_11", "11", 11},   PhoneRow{"objects_16", "16", 16},
    PhoneRow{"objects_21", "21", 21},   PhoneRow{"objects_24", "24", 24, 3289}};
constexpr std::array kShapes = {
    PhoneRow{"spheres_1", "1 sphere"}, PhoneRow{"spheres_2", "2 spheres"},
    PhoneRow{"triangles_1", "1 triangle"}, PhoneRow{"triangles_2", "2 triangles"}};
constexpr std::array kLights = {PhoneRow{"lights_0", "0"}, PhoneRow{"lights_1", "1"}};
constexpr std::array kKinds = {PhoneRow{"kind_one_colour", "one colour"},
                               PhoneRow{"kind_black_and_white", "black and white"},
                               PhoneRow{"kind_noise", "noise"}, PhoneRow{"kind_marble", "marble"}};
constexpr std::array kSizes = {PhoneRow{"size_125", "125", 125}, PhoneRow{"size_250", "250", 250},
                               PhoneRow{"size_500", "500", 500}};

constexpr std::array<PhoneTable, 6> kTables = {{
    {"Texture size", "rows of texels", kTextureSizes},
    {"Objects", "objects", kObjects},
    {"Spheres against triangles", "shapes", kShapes},
    {"Lights", "lights beside the ambient one", kLights},
    {"Textures", "texture", kKinds},
    {"Image size", "pixels a side", kSizes},
}};

}  // namespace

absl::Span<const PhoneTable> phone_tables() { return kTables; }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace bandsaw::coordinator
