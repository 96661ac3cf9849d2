// safetensors.cpp  A file of tensors is refused with one line, or read, converted and packed into a network
// that a reader takes.
#include "baker/common/files/safetensors.hpp"

#include <cstdlib>
#include <cstring>
#include <string>

#include "baker/pack/network/dense_pack.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "core/aligned_block.hpp"
#include "pack/reader.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/mutate.hpp"
#include "tests/fuzz/refuses.hpp"

using namespace sinew;

namespace {

void open(const baker::PackWriter& writer) {
  const std::vector<std::byte> bytes = writer.finish();
  const core::AlignedBlock block(bytes.size());
  std::memcpy(block.data(), bytes.data(), bytes.size());
  pack::PackView view;
  if (!pack::open_pack({block.data(), bytes.size()}, &view).ok()) std::abort();
}

void use(const baker::Safetensors& file) {
  for (const auto& tensor : file.tensors) {
    fuzz::refuses_or_does([&] { (void)tensor.second.as_f32(); });
    fuzz::refuses_or_does([&] { (void)tensor.second.as_i32(); });
    fuzz::refuses_or_does([&] { (void)file.need(tensor.first, {-1, -1}); });
  }
  fuzz::refuses_or_does([&] {
    baker::PackWriter writer(pack::FileKind::kModel);
    baker::add_network(file, writer);
    open(writer);
  });
  fuzz::refuses_or_does([&] {
    baker::PackWriter writer(pack::FileKind::kModel);
    baker::add_chains(file, writer);
    open(writer);
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FileInMemory file;
  fuzz::refuses_or_does([&] { use(baker::read_safetensors(file.write(data, size))); });
  return 0;
}

// The header is text, of the length that stands before it.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  fuzz::Random random(seed);
  uint64_t header = 0;
  if (size > sizeof header) std::memcpy(&header, data, sizeof header);
  if (header == 0 || header > size - sizeof header || random() % 8 == 0)
    return LLVMFuzzerMutate(data, size, max_size);
  uint8_t* const text = data + sizeof header;
  const std::string numbers(text + header, data + size);
  const size_t most = max_size - sizeof header - numbers.size();
  header = max_size > size ? fuzz::change_json(text, header, most, random) : header;
  std::memcpy(data, &header, sizeof header);
  std::memcpy(text + header, numbers.data(), numbers.size());
  if (!numbers.empty() && random() % 4 == 0) fuzz::change_word({text + header, numbers.size()}, random);
  return sizeof header + header + numbers.size();
}
