#pragma once

// Conversion of the principled materials to and from proto/package.proto. Decoding checks nothing;
// the values are checked by scene/validate.h.

#include "proto/package.pb.h"
#include "renderlib/material/material.h"

namespace bandsaw {

void encode_principled(const Principled& from, package::Principled& to);
Principled decode_principled(const package::Principled& from);

void encode_thin_principled(const ThinPrincipled& from, package::ThinPrincipled& to);
ThinPrincipled decode_thin_principled(const package::ThinPrincipled& from);

}  // namespace bandsaw
