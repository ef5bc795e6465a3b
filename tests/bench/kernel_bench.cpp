// kernel_bench [MESH...] measures how many rays per second are traced by the renderer's own BVHs
// (the class Accel) and by Embree. Embree runs in two modes: robust (no gaps between triangles) and
// fast. All get the same rays (README.md). MESH is a name (tests/bench/kernel_meshes.h) or a file.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/embree_kernel.h"
#include "tests/bench/kernel_meshes.h"
#include "tests/bench/kernel_rays.h"

namespace bandsaw::bench {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;  // rays that one kernel traces in its turn
constexpr int kPasses = 5;                            // turns of each kernel with the same rays

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Bandsaw or a mode of Embree, with one of two queries: the closest hit, or whether there is a
/// hit.
struct Kernel {
  std::string name;
  /// Traces the rays from the first pointer up to the second, which is excluded, and returns the
  /// number of hits.
  std::function<std::size_t(const Ray*, const Ray*)> trace;
  double seconds = 0;  ///< sum over chunks of the minimum time of any pass
  std::size_t hits = 0;
};

/// Times the kernels. They take turns chunk by chunk, so that other load on the machine affects all
/// of them equally. For each chunk the best of several passes counts. The order of the kernels
/// changes with every pass.
void race(const std::vector<Ray>& rays, std::vector<Kernel>& kernels) {
  for (std::size_t first = 0; first < rays.size(); first += kChunk) {
    const Ray* begin = rays.data() + first;
    const Ray* end = begin + std::min(kChunk, rays.size() - first);
    std::vector<double> least(kernels.size(), 1e9);
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
      for (std::size_t k = 0; k < kernels.size(); ++k) {
        const std::size_t kernel = (k + pass) % kernels.size();
        const auto start = std::chrono::steady_clock::now();
        const std::size_t hits = kernels[kernel].trace(begin, end);
        least[kernel] = std::min(least[kernel], seconds_since(start));
        kernels[kernel].hits += pass == 0 ? hits : 0;
      }
    }
    for (std::size_t k = 0; k < kernels.size(); ++k) {
      kernels[k].seconds += least[k];
    }
  }
}

/// Returns a kernel that calls traced.closest(). `traced` MUST outlive the kernel.
template <class Traced>
Kernel closest_kernel(const std::string& name, const Traced& traced) {
  return {name, [&traced](const Ray* ray, const Ray* end) {
            std::size_t hits = 0;
            for (; ray != end; ++ray) {
              hits += traced.closest(*ray) ? 1 : 0;
            }
            return hits;
          }};
}

/// Returns a kernel that calls traced.occluded(). `traced` MUST outlive the kernel.
template <class Traced>
Kernel any_kernel(const std::string& name, const Traced& traced) {
  return {name, [&traced](const Ray* ray, const Ray* end) {
            std::size_t hits = 0;
            for (; ray != end; ++ray) {
              hits += traced.occluded(*ray) ? 1 : 0;
            }
            return hits;
          }};
}

/// Prints one line: millions of rays a second of each kernel, the speed of Bandsaw relative to each
/// mode of Embree, and the numbers of hits.
void report(const char* set, const std::vector<Ray>& rays, std::vector<Kernel> kernels) {
  race(rays, kernels);
  std::printf("%-8s", set);
  for (const Kernel& kernel : kernels) {
    std::printf("  %s %.2f", kernel.name.c_str(),
                static_cast<double>(rays.size()) / kernel.seconds * 1e-6);
  }
  for (std::size_t k = 1; k < kernels.size(); ++k) {
    std::printf("  bandsaw/%s %.2f", kernels[k].name.c_str(),
                kernels[k].seconds / kernels[0].seconds);
  }
  for (const Kernel& kernel : kernels) {
    std::printf("  %zu", kernel.hits);
  }
  std::printf(" hits of %zu\n", rays.size());
}

constexpr const char* kEmbreeConfig = "threads=2,set_affinity=0";

struct BuildSeconds {
  double bandsaw = 1e9;
  double embree = 1e9;
};

/// Returns the minimum time of several builds by Bandsaw, and of as many by Embree. The two take
/// turns.
BuildSeconds build_seconds(const Geometry& geometry, Pool& pool) {
  BuildSeconds least;
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    const Accel accel = Accel::build(geometry, pool);
    least.bandsaw = std::min(least.bandsaw, seconds_since(start));
    if (const auto fast =
            EmbreeKernel::create(geometry.meshes.front(), /*robust=*/false, kEmbreeConfig)) {
      least.embree = std::min(least.embree, fast->build_seconds());
    }
  }
  return least;
}

/// Prints all results for one mesh. Returns the exit code: 2 if there is no such mesh.
int measure(const std::string& name) {
  Geometry geometry;
  geometry.meshes.push_back(bench_mesh(name));
  geometry.instances.push_back({MeshId{0}, MaterialId{0}, {}});
  const Mesh& mesh = geometry.meshes.front();
  if (mesh.triangles.empty()) {
    std::fprintf(stderr, "%s is neither a known mesh nor a file with triangles\n", name.c_str());
    return 2;
  }
  Pool pool(2);
  const BuildSeconds seconds = build_seconds(geometry, pool);
  const Accel accel = Accel::build(geometry, pool);
  const auto triangles = static_cast<double>(mesh.triangles.size());
  std::printf("%s: %zu triangles\n", name.c_str(), mesh.triangles.size());
  std::printf("build     bandsaw %.0f ms, %.1f bytes a triangle", seconds.bandsaw * 1e3,
              static_cast<double>(accel.bytes()) / triangles);
  const auto robust = EmbreeKernel::create(mesh, /*robust=*/true, kEmbreeConfig);
  const auto fast = EmbreeKernel::create(mesh, /*robust=*/false, kEmbreeConfig);
  if (fast) {
    std::printf("; embree %.0f ms, %.1f bytes; time bandsaw/embree %.2f", seconds.embree * 1e3,
                static_cast<double>(fast->bytes()) / triangles, seconds.bandsaw / seconds.embree);
  }
  std::printf("\n");
  const RaySets sets = make_rays(mesh, accel, /*from_within=*/name == "room");
  const auto kernels = [&](auto make) {
    std::vector<Kernel> result = {make("bandsaw", accel)};
    if (fast) {
      result.push_back(make("robust", *robust));
      result.push_back(make("fast", *fast));
    }
    return result;
  };
  const auto closest = [](const char* kernel, const auto& traced) {
    return closest_kernel(kernel, traced);
  };
  const auto any = [](const char* kernel, const auto& traced) {
    return any_kernel(kernel, traced);
  };
  report("primary", sets.primary, kernels(closest));
  report("bounce", sets.bounce, kernels(closest));
  report("shadow", sets.shadow, kernels(any));
  return 0;
}

}  // namespace
}  // namespace bandsaw::bench

int main(int argc, char** argv) {
  std::vector<std::string> meshes(argv + 1, argv + argc);
  if (meshes.empty()) {
    meshes = {"icosphere", "needles", "soup", "room"};
  }
  int result = 0;
  for (const std::string& mesh : meshes) {
    result = std::max(result, bandsaw::bench::measure(mesh));
  }
  return result;
}
