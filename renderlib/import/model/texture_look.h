#pragma once

// How a foreign texture is laid on a surface, and what it seems to hold.

#include <assimp/material.h>

#include "renderlib/texture/texture.h"

namespace bandsaw {

ImageTexture::Wrap wrap_of(aiTextureMapMode mode);

/// Scaled, turned around (0.5, 0.5), moved, as assimp/material.h describes it.
UvTransform uv_transform_of(const aiUVTransform& transform);

/// Whether an 8-bit image is of directions, 0.5 + 0.5 n, that mostly point away from the surface.
bool looks_like_normals(const ImageTexture& image);

}  // namespace bandsaw
