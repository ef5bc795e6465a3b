// Makes the meshes that are profiles turned around an axis: vase, pawn, foot and shade of a lamp.

#include "renderlib/gallery/turned.h"

#include <array>
#include <vector>

#include "renderlib/gallery/lathe.h"

namespace bandsaw::gallery {
namespace {

// Profiles are lists of points (radius, height); lathe.h turns them around the y axis.
constexpr int kAround = 28;  // number of faces of a ring

}  // namespace

std::string vase() {
  constexpr std::array<Vec2, 6> kOutside = {
      {{3.2, 0}, {5.4, 5}, {6.6, 11}, {4.2, 18}, {2.3, 22}, {3.6, 26}}};
  constexpr std::array<Vec2, 5> kInside = {{{3.3, 26}, {2.0, 22}, {3.9, 18}, {5.0, 8}, {0, 1.5}}};
  std::vector<Vec2> profile = {{0, 0}};
  for (const Vec2& point : smooth_profile(kOutside, /*steps=*/4)) {
    profile.push_back(point);
  }
  for (const Vec2& point : smooth_profile(kInside, /*steps=*/3)) {
    profile.push_back(point);
  }
  return lathe_obj(profile, kAround);
}

std::string pawn() {
  constexpr std::array<Vec2, 13> kProfile = {{{1.7, 0.5},
                                              {1.5, 1.1},
                                              {1.0, 1.5},
                                              {0.75, 2.4},
                                              {0.6, 3.4},
                                              {1.05, 3.7},
                                              {0.7, 3.95},
                                              {0.95, 4.5},
                                              {1.02, 4.9},
                                              {0.9, 5.4},
                                              {0.62, 5.75},
                                              {0.3, 5.92},
                                              {0, 5.97}}};
  std::vector<Vec2> profile = {{0, 0}, {1.75, 0}};
  for (const Vec2& point : smooth_profile(kProfile, /*steps=*/2)) {
    profile.push_back(point);
  }
  return lathe_obj(profile, kAround);
}

std::string lamp_foot() {
  constexpr std::array<Vec2, 9> kProfile = {
      {{0, 0}, {7, 0}, {7.2, 0.4}, {7, 0.9}, {5, 1.3}, {0.8, 1.8}, {0.55, 3}, {0.55, 34}, {0, 34}}};
  return lathe_obj(kProfile, kAround);
}

std::string lamp_shade() {
  constexpr std::array<Vec2, 5> kProfile = {{{11, 0}, {6, 12}, {5.8, 12}, {10.8, 0}, {11, 0}}};
  return lathe_obj(kProfile, kAround);
}

}  // namespace bandsaw::gallery
