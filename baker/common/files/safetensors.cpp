// safetensors.cpp  Reader and writer of the safetensors container, and conversion of its numbers.
#include "baker/common/files/safetensors.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"

namespace sinew::baker {
namespace {

static_assert(std::endian::native == std::endian::little, "tensor bytes are used as they lie in the file");

using Json = nlohmann::json;

constexpr uint64_t kMaxHeaderBytes = uint64_t{16} << 20;
constexpr size_t kDataAlignment = 64;

struct DtypeName {
  const char* name;
  Dtype dtype;
  size_t bytes;
};
constexpr DtypeName kDtypes[] = {{"F32", Dtype::kF32, 4},  {"F64", Dtype::kF64, 8}, {"F16", Dtype::kF16, 2},
                                 {"I32", Dtype::kI32, 4},  {"I64", Dtype::kI64, 8}, {"U8", Dtype::kU8, 1},
                                 {"BOOL", Dtype::kBool, 1}};

const DtypeName& entry_of(Dtype dtype) {
  return *std::find_if(std::begin(kDtypes), std::end(kDtypes),
                       [&](const DtypeName& entry) { return entry.dtype == dtype; });
}

// Product of the shape, or the largest size_t if it does not fit.
size_t product(const std::vector<size_t>& shape) {
  size_t count = 1;
  for (size_t size : shape) {
    if (size != 0 && count > std::numeric_limits<size_t>::max() / 16 / size)
      return std::numeric_limits<size_t>::max();
    count *= size;
  }
  return count;
}

std::string describe_shape(const std::vector<long>& shape) {
  std::string text = "(";
  for (size_t k = 0; k < shape.size(); ++k)
    text += (k ? ", " : "") + (shape[k] < 0 ? std::string("any") : std::to_string(shape[k]));
  return text + ")";
}

// ---- numbers ----

template <class To, class From>
To convert_one(From value, const std::string& where) {
  if constexpr (std::is_integral_v<From> && sizeof(From) >= 4) {
    // A float holds every integer up to 2^24.
    const int64_t limit = std::is_same_v<To, float> ? int64_t{1} << 24 : std::numeric_limits<int32_t>::max();
    if (value > limit || value < -limit)
      throw BadInput(where + " holds the integer " + std::to_string(value) + ", too large to be converted");
  }
  return static_cast<To>(value);
}

template <class To, class From>
std::vector<To> convert(const Tensor& tensor) {
  std::vector<To> values(tensor.count());
  for (size_t k = 0; k < values.size(); ++k) {
    From value;
    std::memcpy(static_cast<void*>(&value), tensor.bytes.data() + k * sizeof(From), sizeof(From));
    values[k] = convert_one<To, From>(value, tensor.where);
  }
  return values;
}

// ---- reading ----

// A file being read: what goes wrong is told with its path.
class Parser {
 public:
  Parser(const std::string& path, std::span<const std::byte> bytes) : path_(path), bytes_(bytes) {}

  Safetensors parse() {
    const Json header = parse_header();
    Safetensors file;
    file.path = path_;
    for (const auto& [name, value] : header.items())
      if (name == "__metadata__")
        parse_metadata(value, &file);
      else
        file.tensors[name] = parse_tensor(name, value);
    check_coverage();
    return file;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw BadInput(path_ + ": " + what + "; write the file again");
  }

  Json parse_header() {
    uint64_t size = 0;
    if (bytes_.size() < sizeof size) refuse("not a safetensors file (shorter than 8 bytes)");
    std::memcpy(&size, bytes_.data(), sizeof size);
    if (size > kMaxHeaderBytes) refuse("not a safetensors file (a header of more than 16 MiB)");
    if (size > bytes_.size() - sizeof size) refuse("truncated inside the safetensors header");
    data_ = bytes_.subspan(sizeof size + size);
    const char* text = reinterpret_cast<const char*>(bytes_.data()) + sizeof size;
    Json header = Json::parse(text, text + size, nullptr, false);
    if (!header.is_object()) refuse("not a safetensors file (the header is not a JSON object)");
    return header;
  }

  void parse_metadata(const Json& value, Safetensors* file) const {
    if (!value.is_object()) refuse("__metadata__ is not a JSON object");
    for (const auto& [key, text] : value.items()) {
      if (!text.is_string()) refuse("metadata key '" + key + "' is not a string");
      file->metadata[key] = text.get<std::string>();
    }
  }

  Tensor parse_tensor(const std::string& name, const Json& value) {
    const std::string what = "tensor '" + name + "'";
    Tensor tensor;
    tensor.where = path_ + ": " + what;
    const size_t element_bytes = parse_dtype(what, value, &tensor);
    parse_shape(what, value, &tensor);
    const auto [begin, end] = parse_offsets(what, value);
    const size_t count = product(tensor.shape);
    if (count > data_.size() || count * element_bytes != end - begin)
      refuse(what + ": its shape and dtype do not make the bytes it has");
    const auto* first = reinterpret_cast<const unsigned char*>(data_.data());
    tensor.bytes.assign(first + begin, first + end);
    ranges_.push_back({begin, end, name});
    return tensor;
  }

  size_t parse_dtype(const std::string& what, const Json& value, Tensor* tensor) const {
    const std::string name = value.is_object() && value.contains("dtype") && value["dtype"].is_string()
                                 ? value["dtype"].get<std::string>()
                                 : "";
    for (const DtypeName& entry : kDtypes)
      if (name == entry.name) {
        tensor->dtype = entry.dtype;
        return entry.bytes;
      }
    refuse(what + ": dtype '" + name + "' is not one of F32 F64 F16 I32 I64 U8 BOOL");
  }

  void parse_shape(const std::string& what, const Json& value, Tensor* tensor) const {
    if (!value.contains("shape") || !value["shape"].is_array()) refuse(what + ": no shape");
    for (const Json& size : value["shape"]) {
      if (!size.is_number_unsigned()) refuse(what + ": a size in its shape is not a whole number");
      tensor->shape.push_back(size.get<size_t>());
    }
  }

  std::pair<size_t, size_t> parse_offsets(const std::string& what, const Json& value) const {
    const Json offsets = value.value("data_offsets", Json());
    if (!offsets.is_array() || offsets.size() != 2 || !offsets[0].is_number_unsigned() ||
        !offsets[1].is_number_unsigned())
      refuse(what + ": no data_offsets");
    const size_t begin = offsets[0].get<size_t>(), end = offsets[1].get<size_t>();
    if (begin > end || end > data_.size())
      refuse(what + ": its data_offsets lie outside the file (truncated?)");
    return {begin, end};
  }

  // The container's rule: the tensors' bytes cover the data once.
  void check_coverage() {
    std::sort(ranges_.begin(), ranges_.end(), [](const Range& a, const Range& b) {
      return std::tie(a.begin, a.end) < std::tie(b.begin, b.end);
    });
    size_t at = 0;
    for (const Range& range : ranges_) {
      if (range.begin != at)
        refuse("tensor '" + range.name + "' " + (range.begin < at ? "overlaps another" : "follows a gap"));
      at = range.end;
    }
    if (at != data_.size()) refuse("bytes that no tensor owns at the end");
  }

  struct Range {
    size_t begin, end;
    std::string name;
  };
  const std::string& path_;
  std::span<const std::byte> bytes_, data_;
  std::vector<Range> ranges_;
};

Tensor make_tensor(Dtype dtype, std::vector<size_t> shape, const void* data, size_t bytes) {
  Tensor tensor{dtype, std::move(shape), {}};
  const auto* first = static_cast<const unsigned char*>(data);
  tensor.bytes.assign(first, first + bytes);
  return tensor;
}

}  // namespace

size_t Tensor::count() const { return product(shape); }

std::vector<float> Tensor::as_f32() const {
  switch (dtype) {
    case Dtype::kF32:
      return convert<float, float>(*this);
    case Dtype::kF64:
      return convert<float, double>(*this);
    case Dtype::kF16:
      return convert<float, Eigen::half>(*this);
    case Dtype::kI32:
      return convert<float, int32_t>(*this);
    case Dtype::kI64:
      return convert<float, int64_t>(*this);
    default:
      return convert<float, uint8_t>(*this);
  }
}

std::vector<int32_t> Tensor::as_i32() const {
  switch (dtype) {
    case Dtype::kI32:
      return convert<int32_t, int32_t>(*this);
    case Dtype::kI64:
      return convert<int32_t, int64_t>(*this);
    case Dtype::kU8:
    case Dtype::kBool:
      return convert<int32_t, uint8_t>(*this);
    default:
      throw BadInput(where + " holds floats where integers are needed; write it as I32");
  }
}

const Tensor& Safetensors::need(const std::string& name, const std::vector<long>& shape) const {
  const auto found = tensors.find(name);
  if (found == tensors.end())
    throw BadInput(path + ": tensor '" + name + "' is missing, wanted with shape " + describe_shape(shape));
  const std::vector<size_t>& has = found->second.shape;
  const bool fits =
      std::equal(has.begin(), has.end(), shape.begin(), shape.end(),
                 [](size_t size, long wanted) { return wanted < 0 || size == static_cast<size_t>(wanted); });
  if (!fits)
    throw BadInput(path + ": tensor '" + name + "' has shape " +
                   describe_shape(std::vector<long>(has.begin(), has.end())) + ", wanted " +
                   describe_shape(shape));
  return found->second;
}

Tensor tensor_f32(std::vector<size_t> shape, const std::vector<float>& values) {
  return make_tensor(Dtype::kF32, std::move(shape), values.data(), values.size() * sizeof(float));
}

Tensor tensor_i32(std::vector<size_t> shape, const std::vector<int32_t>& values) {
  return make_tensor(Dtype::kI32, std::move(shape), values.data(), values.size() * sizeof(int32_t));
}

Safetensors read_safetensors(const std::string& path) {
  const std::vector<std::byte> bytes = read_file(path);
  return Parser(path, bytes).parse();
}

void write_safetensors(const std::string& path, const Safetensors& file) {
  Json header = Json::object();
  if (!file.metadata.empty()) header["__metadata__"] = file.metadata;
  size_t end = 0;
  for (const auto& [name, tensor] : file.tensors) {
    const size_t begin = std::exchange(end, end + tensor.bytes.size());
    if (tensor.count() * entry_of(tensor.dtype).bytes != tensor.bytes.size())
      throw BadInput(path + ": tensor '" + name + "' has a shape that its values do not fill");
    header[name] = {
        {"dtype", entry_of(tensor.dtype).name}, {"shape", tensor.shape}, {"data_offsets", {begin, end}}};
  }
  std::string bytes = header.dump();
  bytes.resize((sizeof(uint64_t) + bytes.size() + kDataAlignment - 1) / kDataAlignment * kDataAlignment -
                   sizeof(uint64_t),
               ' ');
  const uint64_t header_bytes = bytes.size();
  bytes.insert(0, reinterpret_cast<const char*>(&header_bytes), sizeof header_bytes);
  for (const auto& [name, tensor] : file.tensors)
    bytes.append(reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size());
  write_file(path, bytes);
}

}  // namespace sinew::baker
