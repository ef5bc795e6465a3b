// Plastic, conductors, thin sheets and the principled materials: samples, values and bounds agree.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "renderlib/material/bsdf.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/plastic_coat.h"
#include "renderlib/math/constants.h"
#include "tests/support/direction_test.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Random;
using test::random_direction;
using Distribution = Microfacets::Distribution;
using Masking = Microfacets::Masking;

const std::vector<Texture> kTextures = {ConstantTexture{{1, 1, 1}},
                                        ConstantTexture{{0.7f, 0.35f, 0.5f}}};
constexpr TextureId kWhite{0};
constexpr TextureId kTinted{1};

SurfacePoint point(const Vec3& shading = {0, 0, 1}) {
  SurfacePoint p;
  p.geometric_normal = {0, 0, 1};
  p.shading_normal = normalize(shading);
  p.along_u = {2, 1, 0};
  p.along_v = {-1, 2, 0};
  return p;
}

/// Returns the BSDF for light that is scattered in the direction `wo`. The geometric normal is +z.
Bsdf bsdf(const Material& material, const Vec3& wo, const Vec3& shading = {0, 0, 1}) {
  return bsdf_at(material, kTextures, point(shading), normalize(wo));
}

/// Returns microfacets with the alpha `u` along the first tangent and `v` along the second.
Microfacets rough(double u, double v, Distribution distribution = Distribution::kGgx,
                  Masking masking = Masking::kSeparable) {
  return {distribution, masking, u, v};
}

Material prepared(const Plastic& plastic) {
  Material material = plastic;
  prepare_materials({&material, 1});
  return material;
}

const ConductorIndex kGold = {{0.143f, 0.375f, 1.44f}, {3.98f, 2.39f, 1.6f}};

struct Named {
  std::string name;
  Material material;
  bool glass = false;            ///< refracts, by an index of 1.5
  bool conserves_energy = true;  ///< reflects at most what it receives, by definition
};

/// Returns a principled material after `set` has changed it.
Named principled(const std::string& name, const std::function<void(Principled&)>& set) {
  Principled m;
  m.base_color = kTinted;
  m.roughness.value = 0.7;
  set(m);
  return {name, m, m.spec_trans.value > 0, false};
}

std::vector<Named> all_materials() {
  ThinPrincipled thin;
  thin.base_color = kTinted;
  thin.roughness.value = 0.95;
  thin.spec_trans.value = 0.6;
  thin.spec_tint.value = 0.5;
  thin.diff_trans.value = 0.4;
  thin.sheen.value = 0.3;
  thin.flatness.value = 0.5;
  const Dielectric beckmann_glass{.surface = rough(0.7, 0.7, Distribution::kBeckmann)};
  const Dielectric brushed_glass{.surface = rough(0.6, 0.9)};
  return {
      {"metal", Conductor{kGold, rough(0.5, 0.5), kWhite}},
      {"correlated metal",
       Conductor{kGold, rough(0.5, 0.7, Distribution::kGgx, Masking::kCorrelated), kWhite}},
      {"Beckmann metal", Conductor{kGold, rough(0.5, 0.5, Distribution::kBeckmann), kTinted}},
      {"correlated Beckmann metal",
       Conductor{kGold, rough(0.6, 0.6, Distribution::kBeckmann, Masking::kCorrelated), kWhite}},
      {"brushed metal", Conductor{std::nullopt, rough(0.3, 0.8), kWhite}},
      {"brushed Beckmann metal",
       Conductor{std::nullopt, rough(0.8, 0.3, Distribution::kBeckmann), kWhite}},
      {"smooth plastic", prepared({kTinted, 1.5})},
      {"plastic", prepared({kTinted, 1.9, rough(0.5, 0.5), {0.5f, 1, 1}, true})},
      {"Beckmann plastic", prepared({kWhite, 1.5, rough(0.4, 0.4, Distribution::kBeckmann)})},
      {"sheet", DiffuseTransmission{kTinted, kWhite}},
      {"Beckmann glass", beckmann_glass, true},
      {"brushed glass", brushed_glass, true},
      principled("principled", [](Principled&) {}),
      principled("principled metal",
                 [](Principled& m) {
                   m.metallic.value = 0.7;
                   m.anisotropic.value = 0.9;
                   m.spec_tint.value = 0.5;
                 }),
      principled("principled glass",
                 [](Principled& m) {
                   m.spec_trans.value = 0.8;
                   m.roughness.value = 0.9;
                   m.clearcoat.value = 0.5;
                 }),
      principled("layered",
                 [](Principled& m) {
                   m.clearcoat.value = 1;
                   m.sheen.value = 1;
                   m.sheen_tint.value = 0.5;
                   m.flatness.value = 0.7;
                 }),
      {"thin principled", thin, false, false}};
}

const Vec3 kDirections[] = {{0, 0, 1}, {0.6, 0.3, 0.5}, {0.3, -0.5, -0.7}};

TEST(Surfaces, SamplesFollowTheirDensity) {
  for (const Named& named : all_materials()) {
    for (const Vec3& wo : kDirections) {
      SCOPED_TRACE(named.name + " " + std::to_string(wo.z));
      const Bsdf b = bsdf(named.material, wo, {0.1, 0.05, 1});
      if (!has_pdf(b)) {
        continue;
      }
      Random lobes(9);
      test::expect_samples_match_density(
          [&](double u, double v) {
            const auto drawn = sample(b, u, v, lobes.uniform());
            return drawn && !drawn->delta ? drawn->wi : Vec3{};
          },
          [&](const Vec3& wi) { return evaluate(b, wi).pdf; }, /*seed=*/17, /*tests=*/51);
    }
  }
}

TEST(Surfaces, SampleWeightsAreValueOverPdf) {
  Random random(12);
  for (const Named& named : all_materials()) {
    for (int i = 0; i < 2000; ++i) {
      const Bsdf b = bsdf(named.material, random_direction(random), random_direction(random));
      const double u = random.uniform();
      const double v = random.uniform();
      const auto drawn = sample(b, u, v, random.uniform());
      if (!drawn || drawn->delta) {
        continue;
      }
      const BsdfValue value = evaluate(b, drawn->wi);
      ASSERT_TRUE(std::isfinite(drawn->pdf) && drawn->pdf > 0) << named.name;
      ASSERT_NEAR(value.pdf / drawn->pdf, 1, 1e-6) << named.name;
      ASSERT_NEAR(value.value.g / drawn->pdf, drawn->weight.g, 2e-6 * (1 + drawn->weight.g))
          << named.name;
    }
  }
}

/// Returns the moments of the weights of samples: the mean is the share of the light that the
/// surface scatters. The compression of radiance in glass is divided out.
test::Moments albedo_of(const Bsdf& b, int samples) {
  Random random(2);
  test::Moments sum;
  for (int i = 0; i < samples; ++i) {
    const double u = random.uniform();
    const double v = random.uniform();
    const auto drawn = sample(b, u, v, random.uniform());
    sum.add(drawn ? drawn->weight.g / drawn->compression : 0);
  }
  return sum;
}

/// Returns a direction whose cosine to the normal is mu.
Vec3 along(double mu) { return {std::sqrt(1 - mu * mu), 0, mu}; }

// Mitsuba's principled definition adds its layers up, so a principled material may scatter more
// light than it receives. With these base colours and at grazing angles, "layered" scatters up to
// 2.5 times the light that it receives. The other principled materials scatter up to 1.35 times the
// light that they receive.
TEST(Surfaces, OnlyPrincipledMaterialsScatterMoreThanTheyReceive) {
  for (const Named& named : all_materials()) {
    for (const double mu : {1.0, 0.7, 0.3, 0.05, -0.4, -0.05}) {
      const test::Moments sum = albedo_of(bsdf(named.material, along(mu)), 4000);
      const double most = named.conserves_energy ? 1 : named.name == "layered" ? 2.5 : 1.35;
      ASSERT_LE(sum.mean(), most + 0.005 + 4 * sum.standard_error()) << named.name << " " << mu;
    }
  }
}

TEST(Surfaces, LosslessSurfacesReflectAllLight) {
  const Material plastic = prepared({kWhite, 1.5});
  const Material saturated = prepared({kWhite, 2.5, {}, {1, 1, 1}, true});
  for (const double mu : {1.0, 0.5, 0.1}) {
    for (const Material& material : {plastic, saturated, Material(ThinDielectric{1.5}),
                                     Material(DiffuseTransmission{kTinted, kWhite}),
                                     Material(Conductor{std::nullopt, {}, kWhite})}) {
      const test::Moments sum = albedo_of(bsdf(material, along(mu)), 20000);
      EXPECT_NEAR(sum.mean(), 1, 1e-3 + 4 * sum.standard_error()) << mu;
    }
    const Conductor satin{std::nullopt, rough(0.1, 0.1), kWhite};
    EXPECT_GT(albedo_of(bsdf(satin, along(mu)), 2000).mean(), mu > 0.2 ? 0.95 : 0.84);
  }
}

TEST(Surfaces, AreReciprocal) {
  Random random(6);
  for (const Named& named : all_materials()) {
    for (int i = 0; i < 3000; ++i) {
      const Vec3 a = random_direction(random);
      const Vec3 b = random_direction(random);
      const bool crosses = a.z * b.z < 0;
      // Mitsuba's thin sheet drops some directions of its specular transmission, and only for light
      // that goes one way.
      const bool one_way = crosses && named.name == "thin principled";
      if (std::abs(a.z) < 1e-3 || std::abs(b.z) < 1e-3 || (a.z < 0 && !named.glass) || one_way) {
        continue;
      }
      const double ab = evaluate(bsdf(named.material, a), b).value.g / std::abs(b.z);
      const double ba = evaluate(bsdf(named.material, b), a).value.g / std::abs(a.z);
      // Radiance through a boundary is scaled by the square of the index.
      const double scale = !crosses || !named.glass ? 1 : a.z > 0 ? 1.5 * 1.5 : 1 / (1.5 * 1.5);
      ASSERT_NEAR(ab * scale, ba, 2e-5 * (1e-2 + ba)) << named.name;
    }
  }
}

TEST(Surfaces, OpaqueSurfacesPassNoLightForAnyNormals) {
  Random random(4);
  for (const Named& named : all_materials()) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = random_direction(random);
      const Vec3 wi = random_direction(random);
      const Bsdf b = bsdf(named.material, wo, random_direction(random));
      if (has_pdf_behind(b)) {
        break;
      }
      if (wo.z * wi.z < 0) {
        ASSERT_EQ(evaluate(b, wi).pdf, 0) << named.name;
        ASSERT_TRUE(is_black(evaluate(b, wi).value)) << named.name;
      }
      const double u = random.uniform();
      const double v = random.uniform();
      const auto drawn = sample(b, u, v, random.uniform());
      ASSERT_TRUE(!drawn || wo.z * drawn->wi.z > 0) << named.name;
    }
  }
}

TEST(Surfaces, EdgesOfTheRangesOfParametersGiveFiniteNumbers) {
  const double least = 0x1p-32;
  for (const Named& named : all_materials()) {
    for (const Vec3& wo : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{1, 0, 1e-12}, Vec3{1, 0, -1e-4}}) {
      const Bsdf b = bsdf(named.material, wo);
      const BsdfValue back = evaluate(b, -normalize(wo));
      ASSERT_TRUE(is_finite(back.value) && std::isfinite(back.pdf)) << named.name;
      for (const double u : {0.0, least, 1 - least}) {
        for (const double v : {0.0, least, 1 - least}) {
          for (const double w : {0.0, 0.5, 1 - least}) {
            const auto drawn = sample(b, u, v, w);
            ASSERT_TRUE(!drawn || (is_finite(drawn->wi) && is_finite(drawn->weight) &&
                                   std::isfinite(drawn->pdf)))
                << named.name;
          }
        }
      }
    }
  }
}

TEST(Surfaces, OneSidedSurfacesAreBlackFromBehind) {
  for (Material material : {Material(Diffuse{kWhite}), Material(Conductor{kGold, {}, kWhite})}) {
    material.one_sided = true;
    EXPECT_TRUE(std::holds_alternative<BlackBsdf>(bsdf(material, {0, 0.1, -1})));
    EXPECT_FALSE(std::holds_alternative<BlackBsdf>(bsdf(material, {0, 0.1, 1})));
  }
}

// ---- Closed forms ----

TEST(ConductorFresnel, AgreesWithClosedForms) {
  for (const double k : {0.0, 0.5, 4.0}) {
    const double n = 1.3;
    const double normal = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    EXPECT_NEAR(conductor_fresnel(1, n, k), normal, 1e-14);
    EXPECT_NEAR(conductor_fresnel(0, n, k), 1, 1e-14);
  }
  for (const double mu : {0.9, 0.5, 0.1}) {
    EXPECT_NEAR(conductor_fresnel(mu, 1.5, 0), fresnel(mu, 1.5), 1e-14)
        << "k = 0 must give a dielectric";
  }
}

// The probabilities of all facets that are seen from a direction sum to 1. For Beckmann the sum has
// the error of the rational approximation of the masking.
TEST(Facets, VisibleFacetsSumToOne) {
  for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    const Facets facets{0.3, 0.8, distribution, Masking::kSeparable};
    for (const double mu : {1.0, 0.5, 0.1}) {
      const Vec3 o = along(mu);
      Random random(3);
      test::Moments sum;
      for (int i = 0; i < 40000; ++i) {
        const double u = random.uniform();
        sum.add(facet_ratio(o, sample_facet(o, facets, u, random.uniform()), facets));
      }
      EXPECT_NEAR(sum.mean(), 1, 4e-3 + 4 * sum.standard_error()) << mu;
    }
  }
}

/// Returns the transmittance of a rough boundary with the relative index of refraction eta, for
/// light whose cosine to the normal is mu. The integral over the facets' normals is computed with
/// the definitions of the distributions.
double transmittance_of(double mu, double eta, const Facets& f) {
  constexpr int kSteps = 400;
  const Vec3 o = along(mu);
  const double a2 = f.alpha_u * f.alpha_u;
  double sum = 0;
  for (int a = 0; a < kSteps; ++a) {
    for (int b = 0; b < kSteps; ++b) {
      const double theta = (a + 0.5) / kSteps * kPi / 2;
      const double phi = (b + 0.5) / kSteps * 2 * kPi;
      const Vec3 h{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                   std::cos(theta)};
      const double o_h = dot(o, h);
      const auto cos_t = refracted_cos(std::max(0.0, o_h), eta);
      if (o_h <= 0 || !cos_t) {
        continue;
      }
      const Vec3 t = refracted(o, h, *cos_t, eta);
      const double tan2 = std::tan(theta) * std::tan(theta);
      const double cos4 = h.z * h.z * h.z * h.z;
      const double density = f.distribution == Distribution::kGgx
                                 ? 1 / (kPi * a2 * cos4 * std::pow(1 + tan2 / a2, 2))
                                 : std::exp(-tan2 / a2) / (kPi * a2 * cos4);
      const double solid_angle = std::sin(theta) * kPi * kPi / (kSteps * kSteps);
      sum += t.z < 0 ? (1 - fresnel(o_h, eta)) * facet_masking(o, f) * facet_masking(t, f) * o_h *
                           density * solid_angle / o.z
                     : 0;
    }
  }
  return sum;
}

TEST(PlasticCoat, TransmittanceIsTheIntegralOverTheFacets) {
  for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
    for (const double alpha : {0.2, 0.6}) {
      const PlasticCoat coat(rough(alpha, alpha, distribution), 1.5);
      for (const int node : {63, 40, 10}) {  // of the coat's table of 64 cosines
        const double mu = node / 63.0;
        const Facets facets{alpha, alpha, distribution, Masking::kSeparable};
        EXPECT_NEAR(coat.at(alpha).passing(mu), transmittance_of(mu, 1.5, facets), 2e-3)
            << alpha << " " << mu;
      }
    }
  }
}

TEST(PlasticCoat, ApproachesASmoothCoatAsAlphaGoesToZero) {
  const PlasticCoat smooth({}, 1.5);
  const PlasticCoat satin(rough(2e-3, 2e-3), 1.5);
  EXPECT_NEAR(smooth.at(0).internal_reflectance(), 0.5963, 2e-4) << "d'Eon and Irving 2011";
  // A rough coat takes the mean over 64 cosines, as Mitsuba does. The tolerance allows for the
  // error of this mean.
  EXPECT_NEAR(satin.at(2e-3).internal_reflectance(), 0.5963, 1e-2);
  for (const int node : {63, 40, 20}) {
    const double mu = node / 63.0;
    EXPECT_DOUBLE_EQ(smooth.at(0).passing(mu), 1 - fresnel(mu, 1.5));
    EXPECT_NEAR(satin.at(2e-3).passing(mu), 1 - fresnel(mu, 1.5), 1e-3) << mu;
  }
}

TEST(PlasticCoat, InterpolatesWhereAlphaHasAMap) {
  Microfacets mapped = rough(0.8, 0.8);
  mapped.alpha_u_map = mapped.alpha_v_map = TextureId{0};
  const PlasticCoat coat(mapped, 1.5);
  for (const double alpha : {0.8, 0.35, 0.1, 0.01}) {
    const PlasticCoat exact(rough(alpha, alpha), 1.5);
    for (const double mu : {1.0, 0.4, 0.1}) {
      EXPECT_NEAR(coat.at(alpha).passing(mu), exact.at(alpha).passing(mu), 3e-3)
          << alpha << " " << mu;
    }
    EXPECT_NEAR(coat.at(alpha).internal_reflectance(), exact.at(alpha).internal_reflectance(),
                3e-3);
  }
}

// Along the normal the value is a sum of three terms: Fresnel's 0.04 times the distribution's peak,
// base / pi, and the coat's peak.
TEST(PrincipledBsdf, AgreesWithAClosedFormAlongTheNormal) {
  Principled m;
  m.base_color = kTinted;
  m.roughness.value = 0.5;
  m.clearcoat.value = 0.8;
  const Vec3 n{0, 0, 1};
  const double alpha = 0.25;
  const double a2 = 0.01;
  const double coat = 0.25 * 0.8 * 0.04 * (1 - a2) / (-kPi * std::log(a2) * a2);
  const double expected = 0.04 / (4 * kPi * alpha * alpha) + 0.35 / kPi + coat;
  EXPECT_NEAR(evaluate(bsdf(m, n), n).value.g, expected, 1e-6);
}

TEST(PrincipledBsdf, MetalReflectsItsBaseColour) {
  Principled m;
  m.base_color = kTinted;
  m.metallic.value = 1;
  m.roughness.value = 0.1;
  const auto drawn = sample(bsdf(m, {0, 0, 1}), 0.3, 0.2, 0.1);
  ASSERT_TRUE(drawn);
  EXPECT_NEAR(drawn->weight.r, 0.7, 0.01);
  EXPECT_NEAR(drawn->weight.g, 0.35, 0.01);
}

TEST(ThinDielectric, IncludesReflectionsInsideThePane) {
  const Bsdf b = bsdf(ThinDielectric{1.5, {1, 1, 1}, {0.5f, 1, 1}}, {0.3, 0, 1});
  const double face = fresnel(normalize(Vec3{0.3, 0, 1}).z, 1.5);
  const auto reflected = sample(b, 0, 0, 0);
  ASSERT_TRUE(reflected && reflected->delta);
  const auto passed = sample(b, 0, 0, 0.999);
  ASSERT_TRUE(passed && passed->delta);
  EXPECT_EQ(passed->wi, -normalize(Vec3{0.3, 0, 1}));
  const double pane = 2 * face / (1 + face);
  EXPECT_NEAR(passed->weight.r * (1 - pane), 0.5 * (1 - pane), 1e-6);
  EXPECT_NEAR(passed->weight.g, 1, 1e-6);
  EXPECT_TRUE(passed->counts);
}

// `counts` is true if the scattering counts towards the maximum depth of a path. With the option
// free_passage, light that passes the pane does not count.
TEST(ThinDielectric, AReflectionCountsAndAFreePassageDoesNot) {
  const Bsdf b = bsdf(ThinDielectric{.free_passage = true}, {0.3, 0, 1});
  EXPECT_TRUE(sample(b, 0, 0, 0)->counts) << "a reflection must count";
  EXPECT_FALSE(sample(b, 0, 0, 0.999)->counts);
}

}  // namespace
}  // namespace bandsaw
