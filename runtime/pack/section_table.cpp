// section_table.cpp  The outer shell of a pack: header, section table, checksums.
#include "pack/section_table.hpp"

#include <algorithm>
#include <cstring>

#include "core/hash.hpp"
#include "core/status.hpp"

namespace sinew::pack {
namespace {

using core::make_status;

constexpr uint32_t kMaxSections = 64;

constexpr uint64_t align_up(uint64_t value) noexcept {
  return (value + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment;
}

Status damaged(const char* what) noexcept {
  return make_status(StatusCode::kCorrupt, "the pack's %s; the file is damaged, bake it again", what);
}

Status check_magic(std::span<const std::byte> bytes) noexcept {
  if (bytes.empty())
    return make_status(StatusCode::kNotAPack, "the pack is empty; bake it again with sinew-bake");
  if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    return make_status(StatusCode::kNotAPack,
                       "not a .sinew pack (its first bytes are others); make one with sinew-bake");
  if (bytes.size() < sizeof(FileHeader))
    return make_status(StatusCode::kTruncated,
                       "the pack ends inside its header (%zu of 64 bytes); bake it again", bytes.size());
  return {};
}

Status wrong_version(const FileHeader& header) noexcept {
  const char* command = header.kind == FileKind::kModel
                            ? "sinew-bake model W.safetensors -o M.sinew"
                            : "sinew-bake character IN.glb --recipe R.json --tissue W.safetensors -o C.sinew";
  return make_status(StatusCode::kWrongVersion,
                     "the pack has format version %u and this build reads version %u; bake it again: %s",
                     header.version, kVersion, command);
}

Status check_header(const FileHeader& header, size_t size) noexcept {
  if (header.version != kVersion) return wrong_version(header);
  if (header.file_bytes > size)
    return make_status(StatusCode::kTruncated,
                       "the pack is truncated: %zu of %llu bytes; copy or bake it again", size,
                       static_cast<unsigned long long>(header.file_bytes));
  if (header.file_bytes < size) return damaged("file is longer than its header says");
  if (header.kind != FileKind::kModel && header.kind != FileKind::kCharacter)
    return damaged("kind is neither model nor character");
  const bool zero =
      header.reserved0 == 0 && std::ranges::all_of(header.reserved, [](uint64_t v) { return v == 0; });
  if (!zero) return damaged("header has reserved fields that are not zero");
  if (header.section_count > kMaxSections) return damaged("header states more than 64 sections");
  if (size < sizeof(FileHeader) + header.section_count * sizeof(SectionEntry))
    return damaged("section table does not fit into the file");
  return {};
}

bool all_zero(std::span<const std::byte> bytes) noexcept {
  return std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{0}; });
}

Status section_damaged(const SectionEntry& entry, const char* what) noexcept {
  const SectionRule* rule = find_rule(entry.kind);
  return make_status(StatusCode::kCorrupt,
                     "section %s (kind %u) of the pack %s; the file is damaged, bake it again",
                     rule != nullptr ? rule->name : "unknown", entry.kind, what);
}

// `end` is where the section before it stops; on success, where this one does.
Status check_entry(std::span<const std::byte> bytes, FileKind kind, const SectionEntry& entry,
                   uint64_t* end) noexcept {
  const SectionRule* rule = find_rule(entry.kind);
  if (rule != nullptr && entry.element_bytes != rule->element_bytes)
    return section_damaged(entry, "has elements of the wrong size");
  if (rule != nullptr && kind == FileKind::kModel && rule->kind >= SectionKind::kCharacter)
    return section_damaged(entry, "does not belong into a model");
  if (entry.offset != align_up(*end)) return section_damaged(entry, "is not where the one before it ends");
  if (entry.offset > bytes.size() || entry.element_bytes == 0 ||
      entry.count > (bytes.size() - entry.offset) / entry.element_bytes)
    return section_damaged(entry, "reaches beyond the end of the file");
  if (!all_zero(bytes.subspan(*end, entry.offset - *end)))
    return section_damaged(entry, "has bytes that are not zero in the gap before it");
  const size_t size = entry.count * entry.element_bytes;
  if (!core::has_checksum(bytes.subspan(entry.offset, size), entry.checksum))
    return section_damaged(entry, "fails its checksum");
  *end = entry.offset + size;
  return {};
}

Status check_table(std::span<const std::byte> bytes, const FileHeader& header, SectionTable* out) noexcept {
  const std::span<const std::byte> table =
      bytes.subspan(sizeof(FileHeader), header.section_count * sizeof(SectionEntry));
  if (!core::has_checksum(table, header.table_checksum)) return damaged("section table fails its checksum");
  uint32_t last_kind = 0;
  uint64_t end = sizeof(FileHeader) + table.size();
  for (uint32_t index = 0; index < header.section_count; ++index) {
    SectionEntry entry;
    std::memcpy(&entry, table.data() + index * sizeof entry, sizeof entry);
    if (entry.kind <= last_kind) return damaged("section table does not ascend by kind");
    last_kind = entry.kind;
    if (Status status = check_entry(bytes, header.kind, entry, &end); !status.ok()) return status;
    if (const SectionRule* rule = find_rule(entry.kind))
      out->sections[static_cast<size_t>(rule - kSectionRules)] =
          bytes.subspan(entry.offset, entry.count * entry.element_bytes);
  }
  if (bytes.size() != align_up(end) || !all_zero(bytes.subspan(end)))
    return damaged("bytes after the last section are not its padding");
  return {};
}

}  // namespace

const SectionRule* find_rule(uint32_t kind) noexcept {
  const auto* found = std::ranges::find_if(
      kSectionRules, [&](const SectionRule& rule) { return static_cast<uint32_t>(rule.kind) == kind; });
  return found != std::end(kSectionRules) ? found : nullptr;
}

Status read_section_table(std::span<const std::byte> bytes, SectionTable* out) noexcept {
  if (reinterpret_cast<uintptr_t>(bytes.data()) % kSectionAlignment != 0)
    return make_status(StatusCode::kInvalidArgument,
                       "the pack's bytes are not aligned to 64; map the file or use an aligned buffer");
  if (Status status = check_magic(bytes); !status.ok()) return status;
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  if (Status status = check_header(header, bytes.size()); !status.ok()) return status;
  SectionTable table;
  table.kind = header.kind;
  if (Status status = check_table(bytes, header, &table); !status.ok()) return status;
  *out = table;
  return {};
}

}  // namespace sinew::pack
