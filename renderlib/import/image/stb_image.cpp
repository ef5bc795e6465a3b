// Compiles stb_image, without the formats that scene.proto does not list.
#include <cstdlib>

#define STBI_NO_PSD
#define STBI_NO_GIF
#define STBI_NO_PIC
#define STBI_NO_STDIO
// New memory is cleared, so that the pixels of a damaged file do not depend on its old contents.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(pointer, size) std::realloc(pointer, size)
#define STBI_FREE(pointer) std::free(pointer)
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>
