// The radiance R of scattering half-spaces under a white sky must be within 4 standard errors of
// the closed form of Chandrasekhar, "Radiative Transfer". In this form, mu is the cosine of the
// angle between the viewing direction and the normal:
//
//   R = 1 - H(mu) sqrt(1 - albedo)
//   H(mu) = exp(-mu / pi * integral over x in [0, pi / 2] of f(x))
//   f(x) = ln(1 - albedo * x * cot(x)) / (cos(x)^2 + mu^2 sin(x)^2)
//
// H is from Stibbs and Weir 1959, "On the H-functions for isotropic scattering", MNRAS 119. The
// integral in H was computed to 20 digits. Rounding the albedos to floats changes R by less than
// 1e-7 of R. An id such as V3 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/media.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

struct Seen {
  float albedo;        ///< of single scattering
  double mu;           ///< cosine between the ray and the normal of the half-space
  double reflectance;  ///< radiance along the ray under a sky of radiance 1
};

/// Returns a scene with an isotropic medium of this albedo below y = 0 and a white sky above it.
/// `density` is the extinction coefficient. The sky is an area light, so that it is sampled at
/// every scattering; a background would be found by BSDF sampling alone, which takes many times the
/// samples. The light is a square whose side is 8e6 mean free paths; it leaves out 5e-7 of the sky.
/// A larger square is worse, because a shadow ray ends 2^-40 of the light's size before the light.
/// With a side of 8e9 mean free paths a shadow ray would end a hundredth of a mean free path before
/// the light. Then grazing shadow rays are flatter and longer within the medium, and the half-space
/// is darker by 0.1 %.
std::shared_ptr<const Scene> half_space(float albedo, float density) {
  SceneMaker maker;
  const double far = 4000 / density;
  const double sky = 1e3 * far;
  maker.quad({-sky, 2 / density, -sky}, {2 * sky, 0, 0}, {0, 0, 2 * sky}, maker.lamp(1));
  test::fill_box(maker, {-far, -far, -far}, {far, 0, far},
                 test::add(maker, test::medium((1 - albedo) * density, albedo * density)));
  return maker.build();
}

/// Expects the reflectance of the closed form. `density`: as in half_space(). `error`: the largest
/// standard error that is accepted, relative to the reflectance.
void expect_half_space(const Seen& seen, float density, double error, std::uint64_t samples) {
  const Ray ray{.origin = {0, 1 / density, 0},
                .direction = {std::sqrt(1 - seen.mu * seen.mu), -seen.mu, 0}};
  const Moments radiance =
      test::radiance_along(*half_space(seen.albedo, density), ray, {.max_depth = 1000}, samples);
  EXPECT_LE(std::abs(radiance.z(seen.reflectance)), 4)
      << seen.albedo << " " << seen.mu << ": is " << radiance.mean() << " +- "
      << radiance.standard_error() << ", expected " << seen.reflectance;
  EXPECT_LE(radiance.standard_error(), error * seen.reflectance) << seen.albedo << " " << seen.mu;
}

/// Each accepted standard error is about the smallest that one second of sampling can reach.
TEST(HalfSpace, ReflectanceIsThatOfTheHFunction) {
  for (const Seen& seen :
       {Seen{0.5f, 1, 0.11522588}, Seen{0.5f, 0.5, 0.16014443}, Seen{0.8f, 1, 0.28525450},
        Seen{0.9f, 0.5, 0.50793891}, Seen{0.99f, 1, 0.75272072}}) {
    expect_half_space(seen, 1, 4e-3, seen.albedo > 0.95f ? 1024 : 2048);
  }
}

TEST(HalfSpace, ReflectanceIsThatOfTheHFunctionWithinAThousandth) {
  expect_half_space({0.8f, 0.5, 0.36796976}, 1, 1e-3, 16384);
}

/// A medium that is very dense in units of the scene gives the same result, and every path ends.
TEST(HalfSpace, V3ReflectanceDoesNotDependOnDensity) {
  for (const float density : {1e6f, 1e10f}) {
    expect_half_space({0.8f, 1, 0.28525450}, density, 4e-3, 1024);
  }
  test::report_hard_case("V3", "reflectance of a half-space within 4 SE");
}

}  // namespace
}  // namespace bandsaw
