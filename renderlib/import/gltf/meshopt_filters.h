#pragma once

// The filters of EXT_meshopt_compression (its appendix B). libmeshoptimizer has them too, but with
// approximate reciprocals whose bits differ between makes of CPU; these give the same bits
// everywhere.

#include <cstddef>
#include <string>

namespace bandsaw::gltf {

/// Each decodes the elements in `bytes` in place; `bytes` holds whole elements.

/// Elements of four signed components of 8 bits (`stride` 4) or 16 bits (`stride` 8): x, y and the
/// value that stands for 1, become the normalised integers of a unit vector. The fourth stays.
void decode_octahedral(std::string& bytes, std::size_t stride);
/// Elements of 8 bytes: three components and which of four is missing, become normalised integers
/// of a unit quaternion.
void decode_quaternions(std::string& bytes);
/// Numbers of 4 bytes, an exponent of 8 bits above a mantissa of 24, become floats.
void decode_exponential(std::string& bytes);

}  // namespace bandsaw::gltf
