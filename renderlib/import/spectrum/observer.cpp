// The CIE's tables of the standard observer of 1931 (2 degrees) and of the daylight D65, with
// linear interpolation.

#include "renderlib/import/spectrum/observer.h"

namespace bandsaw::spectrum {
namespace {

constexpr int kStep = 10;  // nanometres between the values of a table
constexpr std::size_t kCount = (kLastNm - kFirstNm) / kStep + 1;

constexpr double kObserver[kCount][3] = {
    {0.0014, 0.0000, 0.0065}, {0.0042, 0.0001, 0.0201}, {0.0143, 0.0004, 0.0679},
    {0.0435, 0.0012, 0.2074}, {0.1344, 0.0040, 0.6456}, {0.2839, 0.0116, 1.3856},
    {0.3483, 0.0230, 1.7471}, {0.3362, 0.0380, 1.7721}, {0.2908, 0.0600, 1.6692},
    {0.1954, 0.0910, 1.2876}, {0.0956, 0.1390, 0.8130}, {0.0320, 0.2080, 0.4652},
    {0.0049, 0.3230, 0.2720}, {0.0093, 0.5030, 0.1582}, {0.0633, 0.7100, 0.0782},
    {0.1655, 0.8620, 0.0422}, {0.2904, 0.9540, 0.0203}, {0.4334, 0.9950, 0.0087},
    {0.5945, 0.9950, 0.0039}, {0.7621, 0.9520, 0.0021}, {0.9163, 0.8700, 0.0017},
    {1.0263, 0.7570, 0.0011}, {1.0622, 0.6310, 0.0008}, {1.0026, 0.5030, 0.0003},
    {0.8544, 0.3810, 0.0002}, {0.6424, 0.2650, 0.0000}, {0.4479, 0.1750, 0.0000},
    {0.2835, 0.1070, 0.0000}, {0.1649, 0.0610, 0.0000}, {0.0874, 0.0320, 0.0000},
    {0.0468, 0.0170, 0.0000}, {0.0227, 0.0082, 0.0000}, {0.0114, 0.0041, 0.0000},
    {0.0058, 0.0021, 0.0000}, {0.0029, 0.0010, 0.0000}, {0.0014, 0.0005, 0.0000},
    {0.0007, 0.0002, 0.0000}, {0.0003, 0.0001, 0.0000}, {0.0002, 0.0001, 0.0000},
    {0.0001, 0.0000, 0.0000}, {0.0000, 0.0000, 0.0000}};

constexpr double kDaylight[kCount] = {
    49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.86, 117.01, 117.81, 114.86, 115.92,
    108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05, 100.00, 96.33,  95.79,  88.69,
    90.01,  89.60,  87.70,  83.29,  83.70,  80.03,  80.21,  82.28,  78.28,  69.72,  71.61,
    74.35,  61.60,  69.89,  75.09,  63.59,  46.42,  66.81,  63.38};

/// Returns the value of a table at a wavelength in [kFirstNm, kLastNm], by linear interpolation.
/// get(i) is the value at kFirstNm + i * kStep.
template <class Get>
double between(int nm, const Get& get) {
  const auto i = static_cast<std::size_t>((nm - kFirstNm) / kStep);
  const double share = static_cast<double>((nm - kFirstNm) % kStep) / kStep;
  return share == 0 ? get(i) : get(i) + share * (get(i + 1) - get(i));
}

}  // namespace

double observer(std::size_t k, int nm) {
  return between(nm, [k](std::size_t i) { return kObserver[i][k]; });
}

double daylight(int nm) {
  return between(nm, [](std::size_t i) { return kDaylight[i]; });
}

}  // namespace bandsaw::spectrum
