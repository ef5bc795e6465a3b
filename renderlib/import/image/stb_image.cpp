// Compiles stb_image with only those image formats that scene.proto lists.
#include <cstdlib>

#define STBI_NO_PSD
#define STBI_NO_GIF
#define STBI_NO_PIC
#define STBI_NO_STDIO
// calloc() sets new memory to zero. If an image file is damaged, the decoder may leave pixels
// unwritten. These pixels are then zero, instead of what the memory held before.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(pointer, size) std::realloc(pointer, size)
#define STBI_FREE(pointer) std::free(pointer)
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>
