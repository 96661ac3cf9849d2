// isa.cpp  Chooses one kernel table.
#include "kernels/isa.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>

#include "core/status.hpp"
#include "hwy/targets.h"
#include "kernels/kernels.hpp"

namespace sinew::simd {
namespace {

constexpr size_t kMaxTables = 18;  // Highway's dynamic targets, and the fallback

struct Available {
  std::array<const Kernels*, kMaxTables> tables{};
  std::array<std::array<char, 16>, kMaxTables> text{};
  std::array<const char*, kMaxTables> names{};
  size_t count = 0;
};

void add_table(const Kernels* table, Available* list) {
  const auto end = list->tables.begin() + static_cast<std::ptrdiff_t>(list->count);
  if (list->count == kMaxTables || std::find(list->tables.begin(), end, table) != end) return;
  const char* name = hwy::TargetName(table->target);
  auto& text = list->text[list->count];
  for (size_t i = 0; name[i] && i + 1 < text.size(); ++i) {
    text[i] = name[i] >= 'A' && name[i] <= 'Z' ? static_cast<char>(name[i] - 'A' + 'a') : name[i];
  }
  list->tables[list->count] = table;
  list->names[list->count++] = text.data();
}

#if HWY_ARCH_WASM  // A browser compiles a module whose instructions it has, or refuses it whole.
bool runs_here(const Kernels&) { return true; }
#else
bool runs_here(const Kernels& table) { return (hwy::SupportedTargets() & table.target) != 0; }
#endif

// The fallback runs everywhere, whatever the processor says of itself.
void find_available(Available* list) {
  const auto compiled = compiled_kernels();
  for (const Kernels* table : compiled) {
    if (table && runs_here(*table)) add_table(table, list);
  }
  if (list->count == 0) add_table(compiled.back(), list);
}

const Available& available() {
  static const Available& list = []() -> const Available& {
    static Available made;
    find_available(&made);
    return made;
  }();
  return list;
}

size_t index_of(const char* name) {
  const Available& list = available();
  size_t i = 0;
  while (i < list.count && std::strcmp(list.names[i], name) != 0) ++i;
  return i;
}

std::atomic<const Kernels*> active_table{nullptr};

// Null when SINEW_ISA is unset or empty.
const char* isa_in_environment() {
  const char* name = std::getenv("SINEW_ISA");
  return name && *name ? name : nullptr;
}

const Kernels* choose_first() {
  const char* wanted = isa_in_environment();
  const size_t index = wanted ? index_of(wanted) : 0;
  return available().tables[index < available().count ? index : 0];
}

Status missing_isa(const char* where, const char* name) {
  char list[128] = {};
  for (size_t i = 0; i < available().count; ++i) {
    if (i) std::strncat(list, ", ", sizeof(list) - std::strlen(list) - 1);
    std::strncat(list, available().names[i], sizeof(list) - std::strlen(list) - 1);
  }
  return core::make_status(
      StatusCode::kUnsupported,
      "%sinstruction set \"%.40s\" is not available; use one this processor and build have: %s", where,
      name ? name : "(null)", list);
}

}  // namespace

const Kernels& kernels() noexcept {
  const Kernels* table = active_table.load(std::memory_order_acquire);
  if (!table) {
    const Kernels* chosen = choose_first();
    if (active_table.compare_exchange_strong(table, chosen)) table = chosen;
  }
  return *table;
}

Status check_environment() noexcept {
  const char* name = isa_in_environment();
  return name && index_of(name) == available().count ? missing_isa("SINEW_ISA: ", name) : Status{};
}

}  // namespace sinew::simd

namespace sinew {

std::span<const char* const> available_isas() noexcept {
  return {simd::available().names.data(), simd::available().count};
}

const char* active_isa() noexcept {
  const simd::Available& list = simd::available();
  const auto found = std::find(list.tables.begin(), list.tables.end(), &simd::kernels());
  return list.names[static_cast<size_t>(found - list.tables.begin())];
}

Status force_isa(const char* name) noexcept {
  const simd::Available& list = simd::available();
  const size_t index = name ? simd::index_of(name) : list.count;
  if (index == list.count) return simd::missing_isa("", name);
  simd::active_table.store(list.tables[index], std::memory_order_release);
  return {};
}

}  // namespace sinew
