#pragma once

// Converts mesh files of Mitsuba scenes. If Bandsaw's importer reads a file as Mitsuba does, the
// file is used unchanged. For any other file, a new file is made.

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include "absl/status/statusor.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/source_mesh.h"
#include "renderlib/import/mitsuba/textures.h"

namespace bandsaw::mitsuba {

/// A mesh as a shape needs it.
struct MeshRequest {
  FoundFile file;
  std::string type;                       ///< "obj", "ply" or "serialized"
  std::int64_t index = 0;                 ///< number of the mesh in a "serialized" file
  bool flip_v = false;                    ///< v of the file is 1 - v of Mitsuba
  bool face_normals = false;              ///< the triangles look flat
  bool turned = false;                    ///< the mesh must be turned inside out
  bool mirrored = false;                  ///< the placement mirrors the mesh
  bool handed = false;                    ///< u, v and the normal must be right-handed
  bool closed = false;                    ///< the file must have one mesh: a medium is inside
  std::set<std::string> attributes = {};  ///< attributes that textures use
};

struct MeshFile {
  std::string name;         ///< name of a file in the import's folder, or of a made file
  TexturedSurface surface;  ///< uvs and attributes, for the material of the mesh
};

/// Provides the mesh files of the converted scene. Equal requests get the same file.
class Meshes {
 public:
  explicit Meshes(Conversion& to) : to_(to) {}

  /// Returns a file with the requested mesh. Returns INVALID_ARGUMENT with the file's name if the
  /// requested file is damaged.
  absl::StatusOr<MeshFile> file_of(const MeshRequest& request);
  /// Returns a made file with `mesh`, changed as `request` says. Of the request only face_normals,
  /// turned, mirrored and attributes are used.
  absl::StatusOr<MeshFile> made_of(SourceMesh mesh, const MeshRequest& request);

 private:
  using Key = std::tuple<std::string, std::int64_t, bool>;
  using MadeKey = std::tuple<std::string, std::int64_t, bool, bool, bool, bool, bool, bool,
                             std::set<std::string>>;
  /// Reads the mesh from the file. Of the request only file, type, index and flip_v are used.
  absl::StatusOr<std::shared_ptr<const SourceMesh>> read(const MeshRequest& request);

  Conversion& to_;
  /// The mesh that was read last: shapes with the same file often follow each other.
  Key last_key_;
  std::shared_ptr<const SourceMesh> last_;
  std::map<MadeKey, MeshFile> known_;
};

}  // namespace bandsaw::mitsuba
