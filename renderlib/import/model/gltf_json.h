#pragma once

// The JSON of a glTF file, and looking things up in it. What is not there, or is of another type,
// is nothing.

#include <google/protobuf/struct.pb.h>

#include <optional>
#include <string>

namespace bandsaw::gltf {

using google::protobuf::ListValue;
using google::protobuf::Struct;
using google::protobuf::Value;

/// The root of a .gltf or .glb; nothing when it cannot be read.
std::optional<Struct> root_of(const std::string& path);

const Value* find(const Struct& in, const std::string& name);
const Struct* object(const Struct& in, const std::string& name);
const ListValue* list(const Struct& in, const std::string& name);
std::optional<double> number(const Struct& in, const std::string& name);
/// `in.extensions.name`.
const Struct* extension(const Struct& in, const std::string& name);
/// Its own name; may be empty.
std::string name_in(const Struct& in);

/// An object of a list of the file, by a number that the file gives.
const Struct* item(const Struct& root, const std::string& name, double index);
/// The same, by the number that stands in `in.member`.
const Struct* item_of(const Struct& root, const std::string& name, const Struct& in,
                      const std::string& member);

}  // namespace bandsaw::gltf
