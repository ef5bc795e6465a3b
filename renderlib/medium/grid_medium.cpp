// The constructor divides the box that contains the grids into cubes, and bounds the density in
// each cube. Coefficients at a point come from look-ups in the grids.

#include "renderlib/medium/grid_medium.h"

#include <algorithm>
#include <cmath>

#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/grid_bounds.h"

namespace bandsaw {
namespace {

using Channels = std::array<double, 3>;

Channels channels_of(const Rgb& color) { return {color.r, color.g, color.b}; }

struct Box {
  Vec3 low;
  Vec3 high;
};

Box both(const Box& a, const Box& b) {
  return {
      {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
      {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

/// Returns a box that contains `map` applied to `box`, in spite of rounding errors.
Box image_of(const Box& box, const Transform& map) {
  const Vec3 center = map.point((box.low + box.high) * 0.5);
  const Vec3 half = (box.high - box.low) * 0.5;
  const auto reach = [&](std::size_t row) {
    const auto& m = map.m[row];
    const double exact =
        std::abs(m[0]) * half.x + std::abs(m[1]) * half.y + std::abs(m[2]) * half.z;
    return exact * (1 + 1e-9);
  };
  const Vec3 around{reach(0), reach(1), reach(2)};
  return {center - around, center + around};
}

Box box_of(const VolumeGrid& grid) {
  return {{},
          {static_cast<double>(grid.cells[0]), static_cast<double>(grid.cells[1]),
           static_cast<double>(grid.cells[2])}};
}

/// Returns the inverse of `regular`, the transform of a valid grid, which is always invertible.
Transform inverse_of(const Transform& regular) { return inverse(regular).value_or(Transform{}); }

/// The bounds of a grid in the space of the regions, which is the cell space of one of the grids.
struct Bounded {
  GridBounds bounds;
  std::optional<Transform>
      to_cells;  ///< from the space of the regions; std::nullopt if both spaces are equal

  ValueBounds over(const Box& region) const {
    const Box in_cells = to_cells ? image_of(region, *to_cells) : region;
    return bounds.over(in_cells.low, in_cells.high);
  }
};

/// Returns the smallest side, kBrickSide times a power of two, for which at most `most` cubes of
/// this side fill a box of the given size.
double cube_side(const Vec3& size, double most) {
  double side = kBrickSide;
  while (std::ceil(size.x / side) * std::ceil(size.y / side) * std::ceil(size.z / side) > most) {
    side *= 2;
  }
  return side;
}

}  // namespace

std::optional<GridMedium::Lookup> GridMedium::lookup(const std::optional<GridUse>& use,
                                                     const std::vector<VolumeGrid>& grids) {
  if (!use) {
    return std::nullopt;
  }
  const VolumeGrid& grid = grids[index_of(use->grid)];
  return Lookup{GridReader(grid), inverse_of(grid.to_medium), double{use->scale}};
}

GridMedium::GridMedium(const Medium& medium, const std::vector<VolumeGrid>& grids)
    : scattering_(channels_of(medium.scattering)),
      emission_(channels_of(medium.emission)),
      g_(medium.g),
      density_(lookup(medium.grids.density, grids)),
      albedo_(lookup(medium.grids.albedo, grids)),
      emitted_(lookup(medium.grids.emission, grids)),
      temperature_(lookup(medium.grids.temperature, grids)),
      temperature_offset_(medium.grids.temperature_offset) {
  const Channels absorption = channels_of(medium.absorption);
  for (std::size_t c = 0; c < 3; ++c) {
    extinction_[c] = absorption[c] + scattering_[c];
    max_extinction_ = std::max(max_extinction_, extinction_[c]);
  }
  scatters_ = max_extinction_ > 0 && (albedo_ || !is_black(medium.scattering));
  emits_ = !is_black(medium.emission);
  if (temperature_ && emits_) {
    blackbody_.emplace(medium.grids.blackbody);
  }
  find_regions(medium.grids, grids);
}

void GridMedium::find_regions(const MediumGrids& uses, const std::vector<VolumeGrid>& grids) {
  // The first grid for which bounded() is called determines the regions: they are the bricks of
  // this grid, or cubes of several bricks. bounded() is not called for the albedo grid, which does
  // not affect the bounds.
  const VolumeGrid* primary = nullptr;
  Box block;
  const auto bounded = [&](const std::optional<GridUse>& use) -> std::optional<Bounded> {
    if (!use) {
      return std::nullopt;
    }
    const VolumeGrid& grid = grids[index_of(use->grid)];
    if (primary == nullptr) {
      primary = &grid;
      block = box_of(grid);
      regions_.from_medium = inverse_of(grid.to_medium);
    }
    const bool same = grid.to_medium == primary->to_medium;
    const Box box =
        same ? box_of(grid) : image_of(box_of(grid), regions_.from_medium * grid.to_medium);
    block = both(block, box);
    return Bounded{
        GridBounds(grid),
        same ? std::nullopt : std::optional(inverse_of(grid.to_medium) * primary->to_medium)};
  };
  const std::optional<Bounded> density = bounded(uses.density);
  const std::optional<Bounded> emission = bounded(uses.emission);
  const std::optional<Bounded> temperature = bounded(uses.temperature);

  // Returns the region in which each grid has the bounds that `at(grid)` returns.
  const auto region = [&](const auto& at) {
    Region to;
    const ValueBounds of_density = density ? at(*density) : ValueBounds{1, 1};
    const auto scale = density ? uses.density->scale : 1.0f;
    to.least = of_density.least * scale;
    to.most = of_density.most * scale;
    // `factor` tells whether the factor f of the emission (struct MediumGrids) may be above 0.
    // `hot` tells whether the temperature may be high enough to emit.
    const bool factor = emission ? at(*emission).most > 0 : to.most > 0;
    const bool hot = !temperature || double{at(*temperature).most} * uses.temperature->scale +
                                             temperature_offset_ >=
                                         kDarkKelvin;
    to.emits = emits_ && factor && hot;
    return to;
  };
  regions_.around = region([](const Bounded&) { return ValueBounds{0, 0}; });
  if (primary == nullptr) {
    return;
  }
  regions_.low = block.low;
  regions_.high = block.high;
  const Vec3 size = block.high - block.low;
  regions_.side = cube_side(size, static_cast<double>(kMaxGridBricks));
  const auto count = [&](double along) {
    return static_cast<std::uint32_t>(std::max(1.0, std::ceil(along / regions_.side)));
  };
  regions_.count = {count(size.x), count(size.y), count(size.z)};
  for (std::uint32_t z = 0; z < regions_.count[2]; ++z) {
    for (std::uint32_t y = 0; y < regions_.count[1]; ++y) {
      for (std::uint32_t x = 0; x < regions_.count[0]; ++x) {
        const Vec3 low = block.low + Vec3{x * regions_.side, y * regions_.side, z * regions_.side};
        const Vec3 high{std::min(low.x + regions_.side, block.high.x),
                        std::min(low.y + regions_.side, block.high.y),
                        std::min(low.z + regions_.side, block.high.z)};
        regions_.regions.push_back(region([&](const Bounded& grid) {
          return grid.over({low, high});
        }));
      }
    }
  }
}

Channels GridMedium::Lookup::color(const Vec3& at) const {
  const Rgb color = reader.color(from_medium.point(at));
  return {scale * color.r, scale * color.g, scale * color.b};
}

Channels GridMedium::density(const Vec3& at, double most) const {
  if (!density_) {
    return {1, 1, 1};
  }
  if (density_->reader.channels() == 1) {
    const double value = std::min(density_->value(at), most);
    return {value, value, value};
  }
  const Channels value = density_->color(at);
  return {std::min(value[0], most), std::min(value[1], most), std::min(value[2], most)};
}

Coefficients GridMedium::coefficients(const Vec3& at, const Channels& density) const {
  Coefficients result;
  const Channels albedo = albedo_ ? albedo_->color(at) : Channels{};
  for (std::size_t c = 0; c < 3; ++c) {
    result.extinction[c] = density[c] * extinction_[c];
    result.scattering[c] =
        albedo_ ? result.extinction[c] * std::min(1.0, albedo[c]) : density[c] * scattering_[c];
  }
  return result;
}

Channels GridMedium::emission(const Vec3& at, const Channels& density) const {
  Channels factor = emitted_ ? emitted_->color(at) : density;
  if (blackbody_) {
    const Channels hot = channels_of(blackbody_->at(temperature_->value(at) + temperature_offset_));
    for (std::size_t c = 0; c < 3; ++c) {
      factor[c] *= hot[c];
    }
  }
  return {factor[0] * emission_[0], factor[1] * emission_[1], factor[2] * emission_[2]};
}

}  // namespace bandsaw
