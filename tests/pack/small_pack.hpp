// small_pack.hpp  The smallest packs that have everything: two regions, a chain of joints, a clip, every
// input.
#pragma once
#include <cstddef>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/import/character/character.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/pack/network/int8_pack.hpp"
#include "baker/truth/graph_level.hpp"
#include "pack/format.hpp"

namespace sinew::test {

baker::Safetensors small_weights();                    // 32 -> 5 3, self weights, every input
baker::Safetensors small_paper_weights();              // 9 -> 5 3, the paper's wiring
std::vector<baker::HeardRanges> small_paper_ranges();  // of it, all 1
baker::Safetensors small_deep_emulator();              // the paper's sizes
baker::Safetensors small_coping_net();                 // latent 5, 2 blocks, depth 1
// A bar of 12 vertices on three joints, with one clip; two primitives share its vertices.
baker::Character small_character();
baker::TissueLayout small_layout(const baker::Character& character);  // two regions of 3 and 2 nodes

std::vector<baker::ModalBasis> small_modes(const baker::TissueLayout& layout);  // three and two

std::vector<std::byte> small_model();
std::vector<std::byte> small_chain_model();  // of small_coping_net
std::vector<std::byte> small_character_pack();
std::vector<std::byte> small_weightless_pack();
// The same with a coarser control graph: two nodes of three, one of two.
baker::GraphLevel small_coarser_level(const baker::TissueLayout& layout);
std::vector<std::byte> small_levels_pack();
std::vector<std::byte> small_left_out_pack();  // and one graph more, that one without its region 1
std::vector<baker::Rod> small_rods();          // one, of the two upper joints and a link between them
std::vector<std::byte> small_rod_pack();       // the weightless one with it
std::vector<std::byte> small_learned_pack();
// Its first region's nodes are corners of voxels, the first of them held; and what predicts them.
baker::Safetensors small_emulator();
baker::TissueLayout small_patch_layout(const baker::Character& character);
std::vector<std::byte> small_patch_pack();  // the same, starting from a network of latent width 8

}  // namespace sinew::test
