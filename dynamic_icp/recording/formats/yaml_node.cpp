// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/yaml_node.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <streambuf>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

/// The length of the character at the front of `text` in bytes; 0 where it is not well-formed UTF-8 (RFC 3629).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned lead = byte(0);
  const std::size_t length = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (length == 1) {
    return 1;
  }
  std::uint32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return 0;
    }
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const std::uint32_t least = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  return lead >= 0xC0 && code >= least && code <= 0x10FFFF && !is_surrogate ? length : 0;
}

/// How much of the text is well-formed UTF-8, from the front.
std::size_t utf8_length(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size()) {
    const std::size_t character = character_length(text.substr(length));
    if (character == 0) {
      break;
    }
    length += character;
  }
  return length;
}

/// A text that the parser reads piece by piece, no farther than kMaxYamlPart beyond where it last made a node.
class WatchedText final : public std::streambuf {
 public:
  WatchedText(std::string& text, const std::filesystem::path& origin) : origin_(origin) {
    setg(text.data(), text.data(), text.data() + text.size());
  }

  void note_node() { noted_ = gptr(); }

 private:
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    const char* const from = noted_ == nullptr ? eback() : noted_;
    if (gptr() - from > static_cast<std::ptrdiff_t>(kMaxYamlPart)) {
      const auto line = static_cast<int>(std::count<const char*>(eback(), from, '\n')) + 1;
      throw DataError(fmt::format("{}: here or soon after begins a part of more than {} bytes, expected none as long",
                                  place(origin_, line), kMaxYamlPart));
    }
    return std::streambuf::xsgetn(to, count);
  }

  const std::filesystem::path& origin_;
  const char* noted_ = nullptr;
};

/// Where the documents of a stream begin, and how many nodes they have; what is in them does not matter.
class DocumentMarks final : public YAML::EventHandler {
 public:
  DocumentMarks(WatchedText& text, const std::filesystem::path& origin) : text_(text), origin_(origin) {}

  std::vector<YAML::Mark> marks;

  void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    count(mark);
  }
  void OnMapEnd() override {}

 private:
  void count(const YAML::Mark& mark) {
    text_.note_node();
    if (++nodes_ > kMaxYamlNodes) {
      throw DataError(fmt::format("{}: has more than {} values, lists and maps, expected no more in a file of YAML",
                                  place(origin_, mark.line + 1), kMaxYamlNodes));
    }
  }

  WatchedText& text_;
  const std::filesystem::path& origin_;
  std::size_t nodes_ = 0;
};

/// Throws DataError where a second document begins, and where there are too many nodes. YAML::LoadAll would not do:
/// where nothing can begin, at a comma for instance, it finds empty documents without end.
void refuse_more_documents(std::string& text, const std::filesystem::path& origin) {
  WatchedText watched(text, origin);
  std::istream stream(&watched);
  YAML::Parser parser(stream);
  DocumentMarks documents(watched, origin);
  if (!parser.HandleNextDocument(documents) || !parser.HandleNextDocument(documents)) {
    return;
  }
  const YAML::Mark& first = documents.marks.front();
  const YAML::Mark& second = documents.marks.back();
  throw DataError(fmt::format(
      "{}: {}", place(origin, second.line + 1),
      first.pos == second.pos ? "is no YAML: nothing begins so" : "another document begins here, expected one"));
}

}  // namespace

std::string place(const std::filesystem::path& origin, int line) {
  return fmt::format("{}: line {}", origin.string(), line);
}

int line_of(const YAML::Node& node) { return node.Mark().line + 1; }

/// What was found, in words.
std::string found(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return fmt::format("'{}'", node.Scalar());
    case YAML::NodeType::Sequence:
      return fmt::format("a list of {}", node.size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

YAML::Node parse_document(std::string_view text, const std::filesystem::path& origin) {
  if (text.size() > kMaxYamlBytes) {
    throw DataError(
        fmt::format("{}: has {} bytes, expected at most {} of YAML", origin.string(), text.size(), kMaxYamlBytes));
  }
  const auto control = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
  });
  if (control != text.end()) {  // the parser takes some of them for the end of the file
    const auto line = static_cast<int>(std::count(text.begin(), control, '\n')) + 1;
    throw DataError(fmt::format("{}: is no YAML: has the byte {}", place(origin, line), static_cast<int>(*control)));
  }
  if (const auto length = utf8_length(text); length < text.size()) {
    const auto line =
        static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length), '\n')) + 1;
    throw DataError(fmt::format("{}: is no YAML: has bytes that are not UTF-8", place(origin, line)));
  }
  try {
    std::string stream(text);
    refuse_more_documents(stream, origin);
    const YAML::Node document = YAML::Load(stream);
    return document.IsNull() ? YAML::Node(YAML::NodeType::Undefined) : document;
  } catch (const YAML::Exception& error) {
    throw DataError(fmt::format("{}: is no YAML: {}", place(origin, error.mark.line + 1), error.msg));
  }
}

void SettingsReader::read(const YAML::Node& key_node, const YAML::Node& value, const std::string& key, int depth) {
  constexpr int kMaxDepth = 32;             // an alias may make a map its own part
  constexpr std::size_t kMaxKeys = 10'000;  // and aliases of aliases double their number with every line
  const std::string here = place(origin_, line_of(key_node));
  if (++visited_ > kMaxKeys) {
    throw UsageError(fmt::format("{}: more than {} keys, those of aliases counted each time", here, kMaxKeys));
  }
  if (value.IsMap() && depth < kMaxDepth && (value.size() > 0 || holds_fields(key))) {
    for (const auto& entry : value) {
      const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
      read(entry.first, entry.second, key + "." + name, depth + 1);
    }
    return;
  }
  if (!seen_.insert(key).second) {
    throw UsageError(fmt::format("{}: configuration key '{}' is set twice", here, key));
  }
  try {
    set_field(fields_, key, value.IsScalar() ? value.Scalar() : "");
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", here, error.what()));
  }
}

bool SettingsReader::holds_fields(const std::string& key) const {
  return std::any_of(fields_.begin(), fields_.end(),
                     [&](const ConfigField& field) { return field.key.starts_with(key + "."); });
}

}  // namespace dynamic_icp::formats
