#pragma once

// The filters of EXT_meshopt_compression (its appendix B), which meshopt_view.h applies to decoded
// streams. libmeshoptimizer has them too, but with approximate reciprocals whose bits differ
// between CPU models; the functions here give the same bits everywhere.

#include <cstddef>
#include <string>

namespace bandsaw::gltf {

/// All functions decode the elements in `bytes` in place; `bytes` MUST contain whole elements.

/// Decodes elements to normalised integers of a unit vector. An element has four signed components
/// of 8 bits (`stride` 4) or 16 bits (`stride` 8): x, y, the value that stands for 1, and a fourth
/// component, which stays unchanged.
void decode_octahedral(std::string& bytes, std::size_t stride);
/// Decodes elements of 8 bytes to normalised integers of a unit quaternion. An element has three of
/// the four components and the index of the missing one.
void decode_quaternions(std::string& bytes);
/// Decodes numbers of 4 bytes to floats. The upper 8 bits are the exponent, the lower 24 bits the
/// mantissa.
void decode_exponential(std::string& bytes);

}  // namespace bandsaw::gltf
