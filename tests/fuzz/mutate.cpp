#include "tests/fuzz/mutate.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace irad::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kGlb = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr int kMaxDepth = 256;  // the library's own recursion (dump, copy) is not what is tested

bool tooDeep(std::span<const uint8_t> text) {
  int depth = 0, deepest = 0;
  for (const uint8_t c : text) {
    depth += c == '{' || c == '[';
    depth -= c == '}' || c == ']';
    deepest = std::max(deepest, depth);
  }
  return deepest > kMaxDepth;
}

/// A text or GLB file taken apart.
struct Parts {
  Json json;
  std::vector<uint8_t> bin;
  bool glb = false;
};

uint32_t word(std::span<const uint8_t> bytes, size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

bool parse(std::span<const uint8_t> in, Parts& out) {
  std::span<const uint8_t> text = in;
  out.glb = in.size() >= 20 && word(in, 0) == kGlb;
  if (out.glb) {
    const uint64_t length = word(in, 12);
    if (20 + length > in.size()) return false;
    text = in.subspan(20, length);
    const std::span<const uint8_t> rest = in.subspan(20 + length);
    if (rest.size() >= 8) out.bin.assign(rest.begin() + 8, rest.end());
  }
  if (tooDeep(text)) return false;
  out.json = Json::parse(text.begin(), text.end(), nullptr, /*allow_exceptions=*/false);
  return out.json.is_structured();
}

void append(std::vector<uint8_t>& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<uint8_t>(value >> shift));
}

std::vector<uint8_t> assemble(const Parts& parts) {
  std::string text = parts.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!parts.glb) return {text.begin(), text.end()};
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> bin = parts.bin;
  bin.resize((bin.size() + 3) / 4 * 4, 0);
  std::vector<uint8_t> out;
  append(out, kGlb), append(out, 2);
  append(out, static_cast<uint32_t>(20 + text.size() + (bin.empty() ? 0 : 8 + bin.size())));
  append(out, static_cast<uint32_t>(text.size())), append(out, kJsonChunk);
  out.insert(out.end(), text.begin(), text.end());
  if (bin.empty()) return out;
  append(out, static_cast<uint32_t>(bin.size())), append(out, kBinChunk);
  out.insert(out.end(), bin.begin(), bin.end());
  return out;
}

void collect(Json& value, std::vector<Json*>& out) {
  out.push_back(&value);
  if (value.is_structured())
    for (Json& element : value) collect(element, out);
}

class JsonMutation {
 public:
  JsonMutation(Mutator& mutator, Json& root) : mutator_(mutator) { collect(root, all_); }

  void once() {
    Json& value = *all_[below(all_.size())];
    if (value.is_object()) return changeObject(value);
    if (value.is_array()) return changeArray(value);
    if (below(8) == 0) {
      value = copyOfAny();
    } else if (value.is_number()) {
      value = number(value);
    } else if (value.is_string()) {
      value = string(value.get<std::string>());
    } else {
      value = below(2) == 0;
    }
  }

 private:
  Mutator& mutator_;
  std::vector<Json*> all_;

  size_t below(size_t end) { return mutator_.random() % end; }
  Json copyOfAny() { return Json(*all_[below(all_.size())]); }

  std::string key() { return mutator_.words.empty() ? std::string("a") : mutator_.words[below(mutator_.words.size())]; }

  std::string string(std::string text) {
    if (below(2) == 0) return key();
    const size_t size = text.size();
    text.resize(size + 32);
    text.resize(mutator_.bytes(reinterpret_cast<uint8_t*>(text.data()), size, text.size()));
    return text;
  }

  /// Bounds of the integer types and of fp32, powers of two, neighbours, and the signs of zero.
  Json number(const Json& old) {
    static const Json edges = {0,          1,          2,           3,           -1,          4,       127,    128,
                               255,        256,        32767,       65535,       65536,       1 << 24, 0.5,    -0.0,
                               2147483647, 2147483648, 4294967295u, 4294967296u, -2147483648, 1e-30,   -1e-30, 1e-45,
                               1e30,       3.4e38,     1e39,        1e300,       -1e30,       1e15,    1e12,   0.1};
    const double value = old.get<double>();
    const bool integer = old.is_number_integer() && std::abs(value) < 1e15;
    switch (below(6)) {
      case 0:
        return integer ? Json(old.get<int64_t>() + 1) : Json(value * 2.0);
      case 1:
        return integer ? Json(old.get<int64_t>() - 1) : Json(-value);
      case 2:
        return integer ? Json(old.get<int64_t>() * 2) : Json(value / 3.0);
      case 3:
        return Json(int64_t{1} << below(63));
      default:
        return edges[below(edges.size())];
    }
  }

  Json leafOrCopy() {
    switch (below(4)) {
      case 0:
        return number(0);
      case 1:
        return key();
      default:
        return copyOfAny();
    }
  }

  void changeObject(Json& object) {
    auto at = object.begin();
    if (!object.empty()) std::advance(at, below(object.size()));
    switch (below(4)) {
      case 0:
        if (!object.empty()) object.erase(at);
        break;
      case 1:
        if (!object.empty()) {  // the same value under another name
          Json value = *at;
          object.erase(at);
          object[key()] = std::move(value);
        }
        break;
      case 2:
        object[key()] = leafOrCopy();
        break;
      default:
        if (!object.empty()) *at = leafOrCopy();
    }
  }

  void changeArray(Json& array) {
    const size_t at = array.empty() ? 0 : below(array.size());
    switch (below(4)) {
      case 0:
        if (!array.empty()) array.erase(at);
        break;
      case 1:
        if (!array.empty()) array.insert(array.begin() + static_cast<int64_t>(at), Json(array[at]));
        break;
      case 2:
        if (!array.empty()) std::swap(array[at], array[below(array.size())]);
        break;
      default:
        array.push_back(leafOrCopy());
    }
  }
};

}  // namespace

std::vector<uint8_t> Mutator::operator()(std::span<const uint8_t> in, size_t capacity) {
  Parts parts;
  // Now and then the form itself: headers, lengths, the text of the JSON.
  if (random() % 10 != 0 && parse(in, parts)) {
    for (size_t left = 1 + random() % 4; left > 0; --left) {
      if (!parts.bin.empty() && random() % 3 == 0) {
        const size_t size = parts.bin.size();
        parts.bin.resize(size + 64);
        parts.bin.resize(bytes(parts.bin.data(), size, parts.bin.size()));
      } else {
        JsonMutation(*this, parts.json).once();
      }
      if (!parts.json.is_structured()) break;
    }
    std::vector<uint8_t> out = assemble(parts);
    if (out.size() <= capacity) return out;
  }
  std::vector<uint8_t> out(in.begin(), in.end());
  out.resize(capacity);
  out.resize(bytes(out.data(), in.size(), capacity));
  return out;
}

std::vector<std::string> readWords(const char* path) {
  std::vector<std::string> words;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.size() > 2 && line.front() == '"' && line.back() == '"' && line.find('\\') == std::string::npos)
      words.push_back(line.substr(1, line.size() - 2));
  return words;
}

}  // namespace irad::fuzz
