// Chooses a time, samples a point of a caster (a surface that casts caustics), chooses one side of
// the surface at random, and samples a light for this side.

#include "renderlib/integrate/photon_start.h"

#include "renderlib/camera/camera.h"

namespace bandsaw {

std::optional<PhotonStart> start_photon(const Scene& scene, const Casters& casters,
                                        const PixelSampler& sampler, std::uint64_t sample) {
  const Sample4 place = sampler.group(sample, kGroupCamera);
  const Sample4 choice = sampler.group(sample, kGroupTime);
  const Shutter& shutter = shutter_of(scene.camera());
  const double time = shutter.open + choice[0] * (shutter.close - shutter.open);
  const Sample4 toward = sampler.group(sample, group_light(0));
  // The numbers choice[3] and toward[3] refine the selection among many primitives or lights.
  const std::optional<SurfaceSample> caster =
      casters.sample(choice[1], place[0] + choice[3] * 0x1p-32, place[1], place[2], time);
  if (!caster) {
    return std::nullopt;
  }
  SurfacePoint point = caster->point;
  point.time = time;
  // Light may come from either side.
  const Vec3 normal = place[3] < 0.5 ? point.geometric_normal : -point.geometric_normal;
  const Receiver receiver{point.position, normal, time};
  const std::optional<LightSample> light =
      scene.lights().sample(receiver, toward[0] + toward[3] * 0x1p-32, toward[1], toward[2]);
  return light ? std::optional(PhotonStart{point, normal, *light, caster->pdf}) : std::nullopt;
}

}  // namespace bandsaw
