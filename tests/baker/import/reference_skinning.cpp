// reference_skinning.cpp  Shares no code with the importer, on purpose.
#include "reference_skinning.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;
using Matrix = Eigen::Matrix4d;
using Numbers = std::vector<double>;

std::string decode_base64(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned buffer = 0, bits = 0;
  for (char c : text) {
    if (c == '=') break;
    buffer = buffer << 6 | static_cast<unsigned>(alphabet.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(buffer >> bits & 255u);
  }
  return bytes;
}

std::string whole_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

double number_at(const char* bytes, int type) {
  const auto as = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 5120:
      return as(int8_t{});
    case 5121:
      return as(uint8_t{});
    case 5122:
      return as(int16_t{});
    case 5123:
      return as(uint16_t{});
    case 5125:
      return as(uint32_t{});
    default:
      return as(float{});
  }
}

int type_bytes(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

Numbers slerp(Numbers a, Numbers b, double t) {
  double dot = 0, na = 0, nb = 0;
  for (size_t i = 0; i < 4; ++i) na += a[i] * a[i], nb += b[i] * b[i];
  for (size_t i = 0; i < 4; ++i) a[i] /= std::sqrt(na), b[i] /= std::sqrt(nb), dot += a[i] * b[i];
  if (dot < 0)
    for (double& x : b) x = -x;
  double cross = 0;  // the angle by both sine and cosine: acos alone loses half the digits of small angles
  for (size_t i = 0; i < 4; ++i) cross += (b[i] - std::abs(dot) * a[i]) * (b[i] - std::abs(dot) * a[i]);
  const double angle = std::atan2(std::sqrt(cross), std::abs(dot));
  Numbers result(4);
  for (size_t i = 0; i < 4; ++i)
    result[i] = angle < 1e-12
                    ? a[i]
                    : (std::sin((1 - t) * angle) * a[i] + std::sin(t * angle) * b[i]) / std::sin(angle);
  return result;
}

Matrix trs(const Numbers& t, Numbers r, const Numbers& s) {
  double norm = 0;
  for (double x : r) norm += x * x;
  for (double& x : r) x /= std::sqrt(norm);
  const double x = r[0], y = r[1], z = r[2], w = r[3];
  Matrix m = Matrix::Identity();
  m.block<3, 3>(0, 0) << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),  //
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),                     //
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y);
  for (int k = 0; k < 3; ++k) m.col(k) *= s[static_cast<size_t>(k)];
  for (int k = 0; k < 3; ++k) m(k, 3) = t[static_cast<size_t>(k)];
  return m;
}

}  // namespace

struct ReferenceFile::Impl {
  Json json;
  std::vector<std::string> buffers;
  std::map<int, int> parent;

  Numbers accessor(int index) const {
    const Json& a = json["accessors"][static_cast<size_t>(index)];
    const Json& view = json["bufferViews"][a["bufferView"].get<size_t>()];
    const std::map<std::string, int> widths = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const int width = widths.at(a["type"].get<std::string>()), type = a["componentType"].get<int>(),
              bytes = type_bytes(type);
    const int stride = view.value("byteStride", width * bytes);
    const char* start =
        buffers[view["buffer"].get<size_t>()].data() + view.value("byteOffset", 0) + a.value("byteOffset", 0);
    const double scale = a.value("normalized", false) ? (type == 5121 ? 255.0 : 65535.0) : 1.0;
    Numbers values;
    for (int i = 0; i < a["count"].get<int>(); ++i)
      for (int k = 0; k < width; ++k)
        values.push_back(number_at(start + i * stride + k * bytes, type) / scale);
    return values;
  }

  // A node's translation, rotation or scale under a clip, or what the node says.
  Numbers property(int node, const std::string& path, int clip, double t, Numbers otherwise) const {
    const Json& file = json["nodes"][static_cast<size_t>(node)];
    Numbers value = file.contains(path) ? file[path].get<Numbers>() : otherwise;
    if (clip < 0) return value;
    const Json& animation = json["animations"][static_cast<size_t>(clip)];
    for (const Json& channel : animation["channels"])
      if (channel["target"].value("node", -1) == node && channel["target"]["path"] == path)
        value = sample(animation["samplers"][channel["sampler"].get<size_t>()], value.size(),
                       path == "rotation", t);
    return value;
  }

  Numbers sample(const Json& sampler, size_t width, bool rotation, double t) const {
    const Numbers times = accessor(sampler["input"]), values = accessor(sampler["output"]);
    const std::string kind = sampler.value("interpolation", "LINEAR");
    size_t k = 0;
    while (k + 1 < times.size() && times[k + 1] <= t) ++k;
    const auto key = [&](size_t i) {
      return Numbers(values.begin() + static_cast<long>(i * width),
                     values.begin() + static_cast<long>((i + 1) * width));
    };
    const bool cubic = kind == "CUBICSPLINE";
    if (t <= times[0] || k + 1 == times.size() || kind == "STEP") return cubic ? key(3 * k + 1) : key(k);
    const double td = times[k + 1] - times[k], s = (t - times[k]) / td;
    if (!cubic && rotation) return slerp(key(k), key(k + 1), s);
    Numbers result(width);
    for (size_t i = 0; i < width; ++i) {
      if (!cubic)
        result[i] = (1 - s) * key(k)[i] + s * key(k + 1)[i];
      else
        result[i] = (2 * s * s * s - 3 * s * s + 1) * key(3 * k + 1)[i] +
                    td * (s * s * s - 2 * s * s + s) * key(3 * k + 2)[i] +
                    (-2 * s * s * s + 3 * s * s) * key(3 * k + 4)[i] +
                    td * (s * s * s - s * s) * key(3 * k + 3)[i];
    }
    return result;
  }

  Matrix global(int node, int clip, double t) const {
    const Json& file = json["nodes"][static_cast<size_t>(node)];
    Matrix local;
    if (file.contains("matrix")) {
      const Numbers m = file["matrix"].get<Numbers>();
      for (int i = 0; i < 16; ++i) local(i % 4, i / 4) = m[static_cast<size_t>(i)];
    } else {
      local =
          trs(property(node, "translation", clip, t, {0, 0, 0}),
              property(node, "rotation", clip, t, {0, 0, 0, 1}), property(node, "scale", clip, t, {1, 1, 1}));
    }
    const auto up = parent.find(node);
    return up == parent.end() ? local : Matrix(global(up->second, clip, t) * local);
  }

  std::vector<Matrix> skin_matrices(int skin, int clip, double t) const {
    const Json& file = json["skins"][static_cast<size_t>(skin)];
    const Numbers binds =
        file.contains("inverseBindMatrices") ? accessor(file["inverseBindMatrices"]) : Numbers();
    std::vector<Matrix> matrices;
    for (size_t j = 0; j < file["joints"].size(); ++j) {
      Matrix bind = Matrix::Identity();
      for (size_t i = 0; i < 16 && !binds.empty(); ++i)
        bind(static_cast<int>(i % 4), static_cast<int>(i / 4)) = binds[16 * j + i];
      matrices.push_back(global(file["joints"][j].get<int>(), clip, t) * bind);
    }
    return matrices;
  }

  void append(int node, const Json& attributes, int clip, double t, std::vector<Eigen::Vector3d>* out) const {
    const Numbers places = accessor(attributes["POSITION"]);
    const Json& file = json["nodes"][static_cast<size_t>(node)];
    const bool skinned = file.contains("skin");
    const std::vector<Matrix> skin = skinned ? skin_matrices(file["skin"].get<int>(), clip, t)
                                             : std::vector<Matrix>{global(node, clip, t)};
    const Numbers joints = skinned ? accessor(attributes["JOINTS_0"]) : Numbers(places.size() / 3 * 4, 0);
    const Numbers weights =
        skinned ? accessor(attributes["WEIGHTS_0"]) : Numbers(places.size() / 3 * 4, 0.25);
    for (size_t v = 0; v < places.size() / 3; ++v) {
      const Eigen::Vector4d place(places[3 * v], places[3 * v + 1], places[3 * v + 2], 1);
      Eigen::Vector4d posed = Eigen::Vector4d::Zero();
      double sum = 0;
      for (size_t k = 4 * v; k < 4 * v + 4; ++k) {
        posed += weights[k] * (skin[static_cast<size_t>(joints[k])] * place);
        sum += weights[k];
      }
      out->push_back(posed.head<3>() / sum);
    }
  }
};

ReferenceFile::ReferenceFile(const std::string& path) : impl_(std::make_unique<Impl>()) {
  const std::string bytes = whole_file(path);
  if (bytes.substr(0, 4) == "glTF") {
    uint32_t length;
    std::memcpy(&length, bytes.data() + 12, 4);
    impl_->json = Json::parse(bytes.substr(20, length));
    impl_->buffers.push_back(bytes.substr(28 + length));
  } else {
    impl_->json = Json::parse(bytes);
    for (const Json& buffer : impl_->json["buffers"]) {
      const std::string uri = buffer["uri"];
      impl_->buffers.push_back(uri.starts_with("data:")
                                   ? decode_base64(uri.substr(uri.find(',') + 1))
                                   : whole_file(path.substr(0, path.rfind('/') + 1) + uri));
    }
  }
  for (size_t i = 0; i < impl_->json["nodes"].size(); ++i)
    for (int child : impl_->json["nodes"][i].value("children", std::vector<int>()))
      impl_->parent[child] = static_cast<int>(i);
}

ReferenceFile::~ReferenceFile() = default;

int ReferenceFile::clip_count() const {
  return impl_->json.contains("animations") ? static_cast<int>(impl_->json["animations"].size()) : 0;
}

double ReferenceFile::clip_duration(int clip) const {
  double duration = 0;
  for (const Json& sampler : impl_->json["animations"][static_cast<size_t>(clip)]["samplers"])
    for (double time : impl_->accessor(sampler["input"])) duration = std::max(duration, time);
  return duration;
}

std::vector<Eigen::Vector3d> ReferenceFile::positions(int clip, double t) const {
  std::vector<Eigen::Vector3d> result;
  for (size_t node = 0; node < impl_->json["nodes"].size(); ++node) {
    const Json& file = impl_->json["nodes"][node];
    if (!file.contains("mesh")) continue;
    std::vector<Json> seen;
    for (const Json& primitive : impl_->json["meshes"][file["mesh"].get<size_t>()]["primitives"]) {
      if (std::find(seen.begin(), seen.end(), primitive["attributes"]) != seen.end()) continue;
      seen.push_back(primitive["attributes"]);
      impl_->append(static_cast<int>(node), primitive["attributes"], clip, t, &result);
    }
  }
  return result;
}
