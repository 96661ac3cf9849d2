// checks.hpp  What the runtime later trusts about a pack's content. Every check reads inside the views only,
// in O(their size).
#pragma once
#include "pack/pack_view.hpp"
#include "sinew/status.hpp"

namespace sinew::pack {

Status check_network(const PackView& pack) noexcept;     // network, layers, inputs, weights
Status check_dense(const PackView& pack) noexcept;       // the same of a network of chains
Status check_chains(const ChainsView& chains) noexcept;  // wherever it stands in a pack
Status check_character(const PackView& pack) noexcept;   // joints, mesh, skin, clips, tiers
Status check_primitives(const PackView& pack) noexcept;  // and tangents; after check_character
Status check_tissue(const PackView& pack) noexcept;  // regions, nodes, graph, carry; after check_character
Status check_modes(const PackView& pack) noexcept;   // after check_tissue
// Gives each control graph its part of what levels share, and puts the finest in view. Before all that looks
// at tissue; of what the parts hold nothing is checked.
Status cut_levels(PackView* pack) noexcept;
Status check_levels(const PackView& pack) noexcept;  // each by check_tissue and check_modes, and how they fit
Status check_patches(const PackView& pack) noexcept;  // what a network predicts them by; after check_levels
Status check_rods(const PackView& pack) noexcept;     // rods, segments, what they move; after check_character
Status check_proxies(const PackView& pack) noexcept;  // capsules about bones; after check_character

// ---- shared by all of them ----

// Numbers that are finite each and absurd together overflow in what they are multiplied by. No character is
// so large, no part of one so small, nothing in one so fast or slow; products of what these allow are floats.
inline constexpr float kFarthest_m = 1e5f, kLeastSize_m = 1e-7f;
inline constexpr float kMostOfMatrix = 1e6f;  // as of a pose's (character/motion/pose.hpp)
inline constexpr float kSlowest_hz = 0.1f, kFastest_hz = 1e4f;

// "pack: <what>; the file is damaged, bake it again"
[[gnu::format(printf, 1, 2)]] Status corrupt(const char* format, ...) noexcept;

bool has_int8(const PackView& pack) noexcept;  // any of the int8 sections

// Index of the first NaN or infinity; values.size() if there is none.
size_t first_not_finite(std::span<const float> values) noexcept;
Status check_finite(std::span<const float> values, const char* section) noexcept;
Status check_within(std::span<const float> values, float most, const char* section) noexcept;
Status check_zero(std::span<const uint32_t> reserved, const char* section, size_t index) noexcept;
bool is_unit(const float normal[3]) noexcept;                         // within 1e-3
bool is_positive(float value) noexcept;                               // finite and above 0
bool is_within(float value, float least, float most) noexcept;        // false for NaN
bool are_within(std::span<const float> values, float most) noexcept;  // of either sign
Status check_name(const PackView& pack, uint32_t offset, const char* section, size_t index) noexcept;
Status check_skin(const SkinRecord& skin, size_t joint_count, const char* section, size_t index) noexcept;

using Check = Status (*)(const PackView&) noexcept;
// The first failure of the checks, in order.
Status run_checks(std::span<const Check> checks, const PackView& pack) noexcept;

}  // namespace sinew::pack
