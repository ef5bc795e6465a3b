#pragma once

// Trains the field of path guiding of a scene before the first sample is rendered. The field is a
// pure function of the scene and the key, so every process that renders the scene makes the same
// field. The paths and photons of the training are divided among a fixed number of chunks, whose
// records are joined in order, so that neither threads nor machines change a bit.
//
// Photons come first (training_photons.h). A field is fitted to their records and guides the first
// round of paths (training_paths.h). Then a field is fitted to the records of the photons and of
// this round, and guides the second, larger round.

#include <cstdint>
#include <memory>

#include "renderlib/guiding/guiding_field.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/integrate/training_paths.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Trains the field of the scene: with 3/4 n paths and, if there are casters (surfaces that cast
/// caustics, casters.h), with 2 n photons, where n is the number of pixels of the image, clamped to
/// [2^15, 2^18]. A record is made of each of the first eight vertices of a path, and of each photon
/// that arrives at a surface whose directions can be guided. Each record is held twice during the
/// training. All records together take at most 2 x 93 MB.
///
/// With key.only_if_it_pays, a small training decides first whether a field and photon maps pay. If
/// a field does not pay, it stays empty. If `photon_maps` is true and photon maps pay, the paths of
/// the training take caustics (caustics.h) and indirect light (indirect_photons.h) from these maps.
/// Then TrainedGuiding::sources is set, and all paths that use the field MUST have photon maps too.
/// Returns nullptr if the preparation was stopped.
std::shared_ptr<const TrainedGuiding> train_guiding(const Scene& scene, const GuidingKey& key,
                                                    const Preparation& preparation,
                                                    bool photon_maps = false);

}  // namespace bandsaw
