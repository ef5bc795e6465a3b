#pragma once

// The meshes of a geometry. Copies of the list share the meshes, so that a mesh that is the same in
// all frames of a sequence (the images of an animation) is stored only once.

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "renderlib/geometry/mesh.h"

namespace bandsaw {

class MeshList {
 public:
  using value_type = Mesh;
  class const_iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Mesh;
    using difference_type = std::ptrdiff_t;
    using pointer = const Mesh*;
    using reference = const Mesh&;
    const_iterator() = default;
    explicit const_iterator(const std::shared_ptr<Mesh>* at) : at_(at) {}
    reference operator*() const { return **at_; }
    pointer operator->() const { return at_->get(); }
    const_iterator& operator++() {
      ++at_;
      return *this;
    }
    const_iterator operator++(int) { return const_iterator(at_++); }
    friend bool operator==(const_iterator a, const_iterator b) { return a.at_ == b.at_; }

   private:
    const std::shared_ptr<Mesh>* at_ = nullptr;
  };

  MeshList() = default;
  MeshList(std::initializer_list<Mesh> meshes) {
    for (const Mesh& mesh : meshes) {
      push_back(mesh);
    }
  }

  std::size_t size() const { return meshes_.size(); }
  bool empty() const { return meshes_.empty(); }
  const Mesh& operator[](std::size_t i) const { return *meshes_[i]; }
  const Mesh& at(std::size_t i) const { return *meshes_.at(i); }
  const Mesh& front() const { return *meshes_.front(); }
  const Mesh& back() const { return *meshes_.back(); }
  const_iterator begin() const { return const_iterator(meshes_.data()); }
  const_iterator end() const { return const_iterator(meshes_.data() + meshes_.size()); }

  void push_back(Mesh mesh) { meshes_.push_back(std::make_shared<Mesh>(std::move(mesh))); }
  /// Appends a mesh that another list returned by shared(); both lists then share it.
  void share(std::shared_ptr<const Mesh> mesh) {
    meshes_.push_back(std::const_pointer_cast<Mesh>(std::move(mesh)));
  }
  std::shared_ptr<const Mesh> shared(std::size_t i) const { return meshes_[i]; }
  /// Returns the mesh so that the caller can change it. If other lists share it, this list gets a
  /// copy of its own first. No other list may begin to share it during the call.
  Mesh& change(std::size_t i) {
    if (meshes_[i].use_count() > 1) {
      meshes_[i] = std::make_shared<Mesh>(*meshes_[i]);
    }
    return *meshes_[i];
  }

 private:
  /// No pointer is null. Each mesh was made as Mesh, not as const Mesh, so change() may alter it.
  std::vector<std::shared_ptr<Mesh>> meshes_;
};

}  // namespace bandsaw
