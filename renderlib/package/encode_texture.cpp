#include "renderlib/package/encode_texture.h"

namespace bandsaw {
namespace {

std::uint32_t number(TextureId id) { return static_cast<std::uint32_t>(id); }

void encode(const Rgb& color, package::Rgb& to) {
  for (const float channel : {color.r, color.g, color.b}) {
    to.add_rgb(channel);
  }
}

/// Enums are declared in the same order; some of the protocol's begin with a zero for "not said".
template <class Theirs, class Ours>
Theirs as(Ours ours, int first = 0) {
  return static_cast<Theirs>(static_cast<int>(ours) + first);
}

struct EncodeTexture {
  BlobMap& blobs;
  package::Texture& to;

  void operator()(const ConstantTexture& t) const { encode(t.value, *to.mutable_constant()); }

  void operator()(const ImageTexture& t) const {
    using Proto = package::ImageTexture;
    auto& image = *to.mutable_image();
    image.set_width(t.width);
    image.set_height(t.height);
    image.set_format(as<Proto::Format>(t.format, 1));
    image.set_wrap(as<Proto::Wrap>(t.wrap, 1));
    if (t.wrap_v) {
      image.set_wrap_v(as<Proto::Wrap>(*t.wrap_v, 1));
    }
    image.set_filter(as<Proto::Filter>(t.filter, 1));
    image.set_channels(t.channels);
    image.set_uv_set(as<package::UvSet>(t.uv_set));
    if (!(t.uv_transform == UvTransform{})) {
      image.mutable_uv_transform()->Add(t.uv_transform.m.begin(), t.uv_transform.m.end());
    }
    image.mutable_texels()->set_size(t.texels.size());
    image.mutable_texels()->set_sha256(blobs.put(t.texels).raw());
  }

  void operator()(const CheckerTexture& t) const {
    auto& checker = *to.mutable_checker();
    checker.set_even(number(t.even));
    checker.set_odd(number(t.odd));
    checker.set_mapping(as<package::CheckerTexture::Mapping>(t.mapping));
    for (const double size : {t.size.x, t.size.y, t.size.z}) {
      checker.add_size(size);
    }
    checker.set_uv_set(as<package::UvSet>(t.uv_set));
    checker.set_space(as<package::Space>(t.space));
  }

  void operator()(const NoiseTexture& t) const {
    auto& noise = *to.mutable_noise();
    noise.set_kind(as<package::NoiseTexture::Kind>(t.kind));
    noise.set_space(as<package::Space>(t.space));
    noise.set_octaves(t.octaves);
    noise.set_scale(t.scale);
    noise.set_strength(t.strength);
    noise.set_turbulence_scale(t.turbulence_scale);
    for (const double entry : {t.axis.x, t.axis.y, t.axis.z}) {
      noise.add_axis(entry);
    }
    encode(t.low, *noise.mutable_low());
    encode(t.high, *noise.mutable_high());
  }

  void operator()(const RampTexture& t) const {
    auto& ramp = *to.mutable_ramp();
    ramp.set_over(as<package::RampTexture::Over>(t.over));
    ramp.set_texture(number(t.texture));
    ramp.set_uv_set(as<package::UvSet>(t.uv_set));
    ramp.set_space(as<package::Space>(t.space));
    ramp.set_steps(t.steps);
    for (const RampTexture::Stop& stop : t.stops) {
      ramp.add_at(stop.at);
      for (const float channel : {stop.color.r, stop.color.g, stop.color.b}) {
        ramp.add_color(channel);
      }
    }
  }

  void operator()(const MixTexture& t) const {
    to.mutable_mix()->set_a(number(t.a));
    to.mutable_mix()->set_b(number(t.b));
    to.mutable_mix()->set_amount(number(t.amount));
  }

  void operator()(const ProductTexture& t) const {
    to.mutable_product()->set_a(number(t.a));
    to.mutable_product()->set_b(number(t.b));
  }
};

}  // namespace

void encode_texture(const Texture& texture, BlobMap& blobs, package::Texture& to) {
  std::visit(EncodeTexture{blobs, to}, texture);
}

}  // namespace bandsaw
