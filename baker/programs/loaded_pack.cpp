// loaded_pack.cpp  A pack in memory, checked, for the programs.
#include "baker/programs/loaded_pack.hpp"

#include <cstring>
#include <fstream>

#include "baker/common/bad_input.hpp"
#include "baker/pack/network_pack.hpp"

namespace sinew::baker {

LoadedPack LoadedPack::from_file(const std::string& path) {
  LoadedPack loaded;
  const Status status = pack::MappedFile::open(path.c_str(), &loaded.file_);
  if (!status.ok()) throw BadInput(status.message);
  loaded.open(loaded.file_.bytes(), path);
  return loaded;
}

LoadedPack LoadedPack::from_bytes(std::span<const std::byte> bytes, const std::string& path) {
  LoadedPack loaded;
  loaded.copy_ = core::AlignedBlock(bytes.size());
  if (loaded.copy_.data() == nullptr) throw BadInput(path + ": too large for this machine's memory");
  std::memcpy(loaded.copy_.data(), bytes.data(), bytes.size());
  loaded.open({loaded.copy_.data(), bytes.size()}, path);
  return loaded;
}

LoadedPack LoadedPack::from_pack_or_weights(const std::string& path, pack::Precision precision) {
  if (looks_like_pack(path)) return from_file(path);
  PackWriter writer(pack::FileKind::kModel);
  add_network(read_safetensors(path), writer, precision);
  return from_bytes(writer.finish(), path);
}

void LoadedPack::open(std::span<const std::byte> bytes, const std::string& path) {
  const Status status = pack::open_pack(bytes, &view_);
  if (!status.ok()) throw BadInput(path + ": " + status.message);
  bytes_ = bytes.size();
}

tissue::Network LoadedPack::network() const {
  return {view_.network, view_.layers, view_.inputs, view_.weights.data()};
}

bool looks_like_pack(const std::string& path) {
  char magic[sizeof pack::kMagic] = {};
  std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
  return std::memcmp(magic, pack::kMagic, sizeof magic) == 0 || path.ends_with(".sinew");
}

}  // namespace sinew::baker
