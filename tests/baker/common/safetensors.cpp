// safetensors.cpp  The container's reader refuses what is broken and gives back what was written.
#include "baker/common/files/safetensors.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"
#include "tests/baker/common/temporary_folder.hpp"

using namespace sinew::baker;
using Catch::Contains;
using sinew::test::TemporaryFolder;

namespace {

std::string container(const std::string& header, size_t data_bytes) {
  const uint64_t size = header.size();
  return std::string(reinterpret_cast<const char*>(&size), sizeof size) + header +
         std::string(data_bytes, '\0');
}

// What reading these bytes says; empty if they are taken.
std::string refusal(const TemporaryFolder& folder, const std::string& bytes) {
  const std::string path = folder.file("w.safetensors");
  write_file(path, bytes);
  try {
    read_safetensors(path);
  } catch (const BadInput& error) {
    CHECK_THAT(error.what(), Contains(path) && !Contains("\n"));
    return error.what();
  }
  return "";
}

Safetensors example() {
  Safetensors file;
  file.metadata = {{"sinew.model", "alt_conv_lstm"}, {"unknown", "kept \"whole\""}};
  file.tensors["a"] = tensor_f32({2, 3}, {1, 2, 3, 4, 5, 6});
  file.tensors["b.index"] = tensor_i32({2}, {-7, 9});
  file.tensors["none"] = tensor_f32({0, 3}, {});
  return file;
}

}  // namespace

TEST_CASE("safetensors_refuses_every_kind_of_broken_container") {
  const TemporaryFolder folder;
  const auto one = [](const std::string& entry) { return container("{\"t\":" + entry + "}", 8); };
  CHECK_THAT(refusal(folder, ""), Contains("shorter than 8 bytes"));
  CHECK_THAT(refusal(folder, std::string(8, '\xff')), Contains("more than 16 MiB"));
  CHECK_THAT(refusal(folder, container("{}", 0).substr(0, 9)),
             Contains("truncated inside the safetensors header"));
  CHECK_THAT(refusal(folder, container("[1]", 0)), Contains("not a JSON object"));
  CHECK_THAT(refusal(folder, container("{\"t\":", 0)), Contains("not a JSON object"));
  CHECK_THAT(refusal(folder, container("{\"__metadata__\":{\"k\":1}}", 0)),
             Contains("metadata key 'k' is not a string"));
  CHECK_THAT(refusal(folder, container("{\"__metadata__\":3}", 0)), Contains("__metadata__ is not"));
  CHECK_THAT(refusal(folder, one("5")), Contains("tensor 't': dtype ''"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"BF16","shape":[4],"data_offsets":[0,8]})")),
             Contains("dtype 'BF16'"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","data_offsets":[0,8]})")), Contains("no shape"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[-2],"data_offsets":[0,8]})")),
             Contains("whole number"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[2]})")), Contains("no data_offsets"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[2],"data_offsets":[8,0]})")),
             Contains("outside the file"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[4],"data_offsets":[0,16]})")),
             Contains("outside the file"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[3],"data_offsets":[0,8]})")),
             Contains("do not make the bytes"));
  CHECK_THAT(
      refusal(folder, one(R"({"dtype":"F32","shape":[4294967296,4294967296,2],"data_offsets":[0,8]})")),
      Contains("do not make the bytes"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[1],"data_offsets":[0,4]})")),
             Contains("no tensor owns"));
  CHECK_THAT(refusal(folder, one(R"({"dtype":"F32","shape":[1],"data_offsets":[4,8]})")),
             Contains("follows a gap"));
  CHECK_THAT(refusal(folder, container(R"({"s":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},)"
                                       R"("t":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})",
                                       8)),
             Contains("overlaps another"));
}

TEST_CASE("safetensors_gives_back_what_was_written") {
  const TemporaryFolder folder;
  const std::string path = folder.file("w.safetensors");
  write_safetensors(path, example());
  const Safetensors read = read_safetensors(path);
  CHECK(read.metadata == example().metadata);
  REQUIRE(read.tensors.size() == 3);
  CHECK(read.need("a", {2, -1}).as_f32() == std::vector<float>{1, 2, 3, 4, 5, 6});
  CHECK(read.need("b.index", {2}).as_i32() == std::vector<int32_t>{-7, 9});
  CHECK(read.need("b.index", {-1}).as_f32() == std::vector<float>{-7, 9});
  CHECK(read.need("none", {0, 3}).count() == 0);
}

TEST_CASE("written_data_start_on_a_64_byte_boundary_and_equal_content_has_equal_bytes") {
  const TemporaryFolder folder;
  write_safetensors(folder.file("1"), example());
  write_safetensors(folder.file("2"), example());
  const std::string bytes = read_text(folder.file("1"));
  uint64_t header = 0;
  std::memcpy(&header, bytes.data(), sizeof header);
  CHECK((sizeof header + header) % 64 == 0);
  CHECK(bytes == read_text(folder.file("2")));
}

TEST_CASE("need_names_the_file_the_tensor_and_the_shape") {
  Safetensors file = example();
  file.path = "w.safetensors";
  CHECK_THROWS_WITH(file.need("c", {3}),
                    Contains("w.safetensors: tensor 'c' is missing, wanted with shape (3)"));
  CHECK_THROWS_WITH(file.need("a", {3, -1}), Contains("tensor 'a' has shape (2, 3), wanted (3, any)"));
  CHECK_THROWS_WITH(file.need("a", {6}), Contains("has shape (2, 3), wanted (6)"));
}

TEST_CASE("numbers_are_converted_exactly_or_refused") {
  const auto half = [](uint16_t bits) {
    Tensor tensor{Dtype::kF16, {1}, {}};
    tensor.bytes = {static_cast<unsigned char>(bits & 0xff), static_cast<unsigned char>(bits >> 8)};
    return tensor.as_f32()[0];
  };
  CHECK(half(0x3c00) == 1.0f);
  CHECK(half(0xc000) == -2.0f);
  CHECK(half(0x0001) == 0x1p-24f);
  CHECK(std::isinf(half(0x7c00)));
  CHECK(std::isnan(half(0x7e00)));
  CHECK(tensor_i32({1}, {1 << 24}).as_f32()[0] == 16777216.0f);
  CHECK_THROWS_AS(tensor_i32({1}, {(1 << 24) + 1}).as_f32(), BadInput);
  CHECK_THROWS_WITH(tensor_f32({1}, {1}).as_i32(), Contains("floats where integers are needed"));
}

// Random damage of a valid file is refused or read, never anything else (run under the sanitizers).
TEST_CASE("damaged_safetensors_never_break_the_reader") {
  const TemporaryFolder folder;
  const std::string path = folder.file("w.safetensors");
  write_safetensors(path, example());
  const std::string good = read_text(path);
  std::mt19937 random(7);
  size_t refused = 0;
  constexpr size_t kFlips = 400;
  for (size_t round = 0; round < kFlips; ++round) {
    std::string bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
    refused += refusal(folder, bytes).empty() ? 0 : 1;
  }
  CHECK(refused > 0);
  for (size_t size = 0; size < good.size(); ++size)
    CHECK_FALSE(refusal(folder, good.substr(0, size)).empty());
}
