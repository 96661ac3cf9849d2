// pack_writer.cpp  Sections to a .sinew file, placed as pack/format.hpp fixes it.
#include "baker/pack/pack_writer.hpp"

#include <cstring>

#include "core/hash.hpp"

namespace sinew::baker {
namespace {

constexpr size_t align_up(size_t value) {
  return (value + pack::kSectionAlignment - 1) / pack::kSectionAlignment * pack::kSectionAlignment;
}

}  // namespace

PackWriter PackWriter::from_pack(std::span<const std::byte> bytes) {
  pack::FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  PackWriter writer(header.kind);
  for (uint32_t i = 0; i < header.section_count; ++i) {
    pack::SectionEntry entry;
    std::memcpy(&entry, bytes.data() + sizeof header + i * sizeof entry, sizeof entry);
    writer.add(static_cast<pack::SectionKind>(entry.kind), entry.element_bytes, bytes.data() + entry.offset,
               entry.count * entry.element_bytes);
    const auto* text = reinterpret_cast<const char*>(bytes.data() + entry.offset);
    if (entry.kind == static_cast<uint32_t>(pack::SectionKind::kStrings))
      writer.strings_.assign(text, entry.count);
  }
  return writer;
}

void PackWriter::add(pack::SectionKind kind, uint32_t element_bytes, const void* data, size_t bytes) {
  const auto* first = static_cast<const std::byte*>(data);
  sections_[static_cast<uint32_t>(kind)] = {element_bytes, std::vector<std::byte>(first, first + bytes)};
}

void PackWriter::add_behind(pack::SectionKind kind, uint32_t element_bytes, const void* data, size_t bytes) {
  Section& section = sections_[static_cast<uint32_t>(kind)];
  const auto* first = static_cast<const std::byte*>(data);
  section.element_bytes = element_bytes;
  section.bytes.insert(section.bytes.end(), first, first + bytes);
}

uint32_t PackWriter::string(const std::string& text) {
  const std::string stored = text.substr(0, text.find('\0')) + '\0';
  for (size_t at = 0; at < strings_.size(); at = strings_.find('\0', at) + 1)
    if (strings_.compare(at, stored.size(), stored) == 0) return static_cast<uint32_t>(at);
  strings_ += stored;
  return static_cast<uint32_t>(strings_.size() - stored.size());
}

std::vector<std::byte> PackWriter::finish() const {
  std::map<uint32_t, Section> sections = sections_;
  const auto* text = reinterpret_cast<const std::byte*>(strings_.data());
  sections[static_cast<uint32_t>(pack::SectionKind::kStrings)] = {
      1, std::vector<std::byte>(text, text + strings_.size())};
  std::erase_if(sections, [](const auto& section) { return section.second.bytes.empty(); });

  std::vector<pack::SectionEntry> table;
  size_t end = sizeof(pack::FileHeader) + sections.size() * sizeof(pack::SectionEntry);
  for (const auto& [kind, section] : sections) {
    const size_t offset = align_up(end);
    end = offset + section.bytes.size();
    table.push_back({kind, section.element_bytes, section.bytes.size() / section.element_bytes, offset,
                     core::hash64(section.bytes)});
  }

  std::vector<std::byte> file(align_up(end));
  pack::FileHeader header{};
  std::memcpy(header.magic, pack::kMagic, sizeof header.magic);
  header.version = pack::kVersion;
  header.kind = kind_;
  header.file_bytes = file.size();
  header.section_count = static_cast<uint32_t>(table.size());
  header.table_checksum = core::hash64(std::as_bytes(std::span(table)));
  std::memcpy(file.data(), &header, sizeof header);
  if (table.empty()) return file;
  std::memcpy(file.data() + sizeof header, table.data(), table.size() * sizeof table[0]);
  for (const pack::SectionEntry& entry : table)
    std::memcpy(file.data() + entry.offset, sections.at(entry.kind).bytes.data(),
                entry.count * entry.element_bytes);
  return file;
}

}  // namespace sinew::baker
