// character_tissue.hpp  A character's soft parts and rods with their modes and limits: a bake up to its pack.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/graph_level.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {

// Of rods alone it has neither truth nor bases.
struct CharacterTissue {
  TissueLayout layout;
  std::unique_ptr<TissueTruth> truth;
  std::vector<ModalBasis> finest;
  std::vector<GraphLevel> coarser;
  const Safetensors* rod_weights = nullptr;  // that its rods may start from; outlive it
  const Safetensors* emulator = nullptr;     // that predicts regions on voxels; outlives it
};

// Notes go to the character's. Throws BadInput as layout_tissue and build_cage do.
CharacterTissue make_tissue(Character& character, const Recipe& recipe);

// With these weights, or without; and with the emulator's, if it has them.
std::vector<std::byte> pack_tissue(const Character& character, const CharacterTissue& tissue,
                                   const Safetensors* weights);

// Flesh with a narrow rim tears where other flesh only swings, and so does skin of which a lock has a part:
// limits that no recipe states are lowered until a quick audit of the modal base is within its bounds; notes
// say which.
void lower_limits(Character& character, CharacterTissue& tissue);

}  // namespace sinew::baker
