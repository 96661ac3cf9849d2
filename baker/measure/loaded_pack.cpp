// loaded_pack.cpp  A pack in memory, checked, for the programs.
#include "baker/measure/loaded_pack.hpp"

#include <cstring>
#include <fstream>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/kept_files.hpp"
#include "baker/measure/network/calibrate.hpp"
#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "baker/research/precision/check_int8.hpp"
#include "tissue/network/deep_emulator.hpp"
#include "tissue/network/narrow_layer.hpp"

namespace sinew::baker {

namespace {

// Networks of chains have no states to keep as halves, and no int8 form yet.
void check_precision(const Safetensors& weights, pack::Precision precision) {
  const pack::ModelKind model = model_of(weights);
  if (precision == pack::Precision::kFloat32 || model == pack::ModelKind::kAltConvLstm) return;
  throw BadInput(weights.path + ": a " + pack::kModelNames[static_cast<uint32_t>(model)] +
                 " runs in fp32 only; leave --precision " +
                 pack::kPrecisionNames[static_cast<uint32_t>(precision)] + " out");
}

LoadedPack pack_network(const Safetensors& weights, pack::Precision precision,
                        std::span<const HeardRanges> ranges) {
  PackWriter writer(pack::FileKind::kModel);
  if (model_of(weights) == pack::ModelKind::kAltConvLstm)
    add_network(weights, writer, precision, ranges);
  else
    add_chains(weights, writer);
  return LoadedPack::from_bytes(writer.finish(), weights.path);
}

// Of each hidden layer; empty but for int8.
std::vector<HeardRanges> ranges_for(const Safetensors& weights, pack::Precision precision,
                                    const std::string& calibration) {
  check_precision(weights, precision);
  if (precision != pack::Precision::kInt8) return {};
  const LoadedPack floats = pack_network(weights, pack::Precision::kFloat32, {});
  const std::string vectors = calibration.empty() ? vectors_beside(weights.path) : calibration;
  keep_file(vectors);
  return heard_ranges(floats.network(),
                      vectors.empty() ? made_up_vectors(floats.network()) : read_safetensors(vectors));
}

}  // namespace

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

LoadedPack LoadedPack::from_weights(const std::string& path, pack::Precision precision,
                                    const std::string& calibration) {
  const Safetensors weights = read_safetensors(path);
  return pack_network(weights, precision, ranges_for(weights, precision, calibration));
}

void LoadedPack::open(std::span<const std::byte> bytes, const std::string& path) {
  Status status = pack::open_pack(bytes, &view_);
  if (status.ok()) status = check_int8(view_);
  if (!status.ok()) throw BadInput(path + ": " + status.message);
  bytes_ = bytes;
  const tissue::Network floats = network();
  narrow_ = core::AlignedBlock(tissue::narrow_floats(floats) * sizeof(float));
  if (!narrow_.data()) throw std::bad_alloc();
  tissue::pack_narrow(floats, reinterpret_cast<float*>(narrow_.data()));
}

tissue::Network LoadedPack::network() const {
  return {view_.network, view_.layers, view_.inputs, view_.weights.data(),
          reinterpret_cast<const float*>(narrow_.data())};
}

bool LoadedPack::is_reduced() const {
  return view_.network->precision != pack::Precision::kFloat32 && view_.layers.size() > 1;
}

ReducedNetwork LoadedPack::reduced_network() const {
  return {network(), {view_.int8_weights.data(), view_.int8_sums.data(), view_.int8_scales.data()}};
}

tissue::DeepEmulator LoadedPack::deep_emulator() const { return {view_.dense, view_.weights.data()}; }

rods::CopingNet LoadedPack::coping_net() const { return {view_.network, view_.dense, view_.weights.data()}; }

bool looks_like_pack(const std::string& path) {
  char magic[sizeof pack::kMagic] = {};
  std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
  return std::memcmp(magic, pack::kMagic, sizeof magic) == 0 || path.ends_with(".sinew");
}

}  // namespace sinew::baker
