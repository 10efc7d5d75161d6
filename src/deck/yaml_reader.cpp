#include "deck/yaml_reader.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.h"

namespace sphgeo {

namespace {

/// Control characters. Written unchanged, a terminal would interpret some of them.
bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\r' && c != '\n') || byte == 0x7f;
}

/// Ends the reading after an error that was already reported.
struct Stop {};

/// Size of a value, with the values in it.
struct Weight {
  int nodes = 0;
  std::size_t bytes = 0;
  int depth = 0;  ///< levels of lists and mappings
};

Weight weight_of(const Node& node) {
  Weight w{1, node.text.size(), 0};
  const auto add = [&w](const Node& part) {
    const Weight p = weight_of(part);
    w.nodes += p.nodes;
    w.bytes += p.bytes;
    w.depth = std::max(w.depth, p.depth + 1);
  };
  for (const Node& item : node.items) add(item);
  for (const Entry& e : node.entries) {
    w.bytes += e.key.size();
    add(e.value);
  }
  return w;
}

/// Builds the tree from the parser's events, which show keys and aliases with their own marks; the
/// library's own tree has neither.
class Builder final : public YAML::EventHandler {
 public:
  Builder(std::string name, Diagnostics& found, const YamlLimits& limits)
      : name_(std::move(name)), found_(found), limits_(limits) {}

  Node take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node node;
    node.place = place(mark);
    finish(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) {
      found_.error("E004", place(mark), {}, "an alias refers to something that contains it");
      throw Stop{};
    }
    Node copy = found->second;
    copy.place = place(mark);
    const Weight w = weight_of(copy);
    if (static_cast<int>(open_.size()) + w.depth > limits_.depth) too_deep(copy.place);
    // finish() counts the value itself, one node and its text.
    count(w.nodes - 1, w.bytes - copy.text.size(), copy.place);
    finish(std::move(copy), 0);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node = Node::scalar(value, tag == "!");
    node.place = place(mark);
    refuse_tag(tag, node.place);
    if (value.size() > limits_.text) {
      found_.error("E006", node.place, {},
                   fmt::format("a value of {} characters; at most {} are allowed", value.size(),
                               limits_.text));
      throw Stop{};
    }
    if (const auto control = std::find_if(value.begin(), value.end(), is_control);
        control != value.end()) {
      found_.error("E002", node.place, {},
                   fmt::format("not a text: it contains the byte {}",
                               static_cast<int>(static_cast<unsigned char>(*control))),
                   "remove the control character");
      throw Stop{};
    }
    // The library turns `\N` and `\_` into single bytes.
    if (const std::size_t at = invalid_utf8(value); at != std::string::npos) {
      found_.error("E002", node.place, {},
                   fmt::format("not a text: it contains the byte 0x{:02X}, which is not UTF-8",
                               static_cast<unsigned char>(value[at])),
                   "write \\u0085 in place of \\N and \\u00a0 in place of \\_");
      throw Stop{};
    }
    finish(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(Node::list(), mark, tag, anchor);
  }
  void OnSequenceEnd() override { end(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(Node::map(), mark, tag, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  /// A list or mapping being read.
  struct Open {
    Node node;
    YAML::anchor_t anchor;
    bool has_key = false;  // of a mapping: the next value belongs to `key`
    bool keep = true;      // whether that value is kept (not after a refused key)
    std::string key;
    Place key_place;
  };

  Place place(const YAML::Mark& mark) const {
    if (mark.is_null()) return {name_, 0, 0};
    return {name_, mark.line + 1, mark.column + 1};
  }

  void refuse_tag(const std::string& tag, const Place& at) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    found_.error("E004", at, {}, fmt::format("the tag '{}' is not supported", tag),
                 "remove the tag");
  }

  void count(int nodes, std::size_t bytes, const Place& at) {
    nodes_ += nodes;
    bytes_ += bytes;
    if (nodes_ <= limits_.nodes && bytes_ <= limits_.bytes) return;
    found_.error("E006", at, {},
                 nodes_ > limits_.nodes
                     ? fmt::format("the deck has more than {} values", limits_.nodes)
                     : fmt::format("the deck has more than {} bytes of text", limits_.bytes),
                 "put large tables into a CSV file");
    throw Stop{};
  }

  [[noreturn]] void too_deep(const Place& at) {
    found_.error("E006", at, {},
                 fmt::format("the deck is nested more than {} levels deep", limits_.depth));
    throw Stop{};
  }

  void begin(Node node, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    node.place = place(mark);
    refuse_tag(tag, node.place);
    if (static_cast<int>(open_.size()) >= limits_.depth) too_deep(node.place);
    open_.push_back({std::move(node), anchor, false, true, {}, {}});
  }

  void end() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done.node), done.anchor);
  }

  void finish(Node node, YAML::anchor_t anchor) {
    count(1, node.text.size(), node.place);
    if (anchor != 0) {
      // The kept copy costs as much as the value: anchors within anchors multiply it.
      const Weight w = weight_of(node);
      count(w.nodes, w.bytes, node.place);
      anchored_[anchor] = node;
    }
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& top = open_.back();
    if (top.node.kind == Node::Kind::list) {
      top.node.items.push_back(std::move(node));
    } else if (!top.has_key) {
      take_key(top, node);
    } else {
      // An empty value has no place of its own: the parser's mark is that of whatever follows.
      if (node.kind == Node::Kind::null) node.place = top.key_place;
      if (top.keep) top.node.entries.push_back({top.key, top.key_place, std::move(node)});
      top.has_key = false;
    }
  }

  void take_key(Open& top, const Node& key) {
    top.has_key = true;
    top.keep = false;
    top.key = key.text;
    top.key_place = key.place;
    if (top.key.size() > limits_.key) {
      found_.error("E006", key.place, {},
                   fmt::format("a key of {} characters; at most {} are allowed", top.key.size(),
                               limits_.key));
      throw Stop{};
    }
    if (static_cast<int>(top.node.entries.size()) >= limits_.keys) {
      found_.error("E006", key.place, {},
                   fmt::format("a mapping of more than {} keys", limits_.keys));
      throw Stop{};
    }
    if (key.kind != Node::Kind::scalar) {
      found_.error("E004", key.place, {}, fmt::format("a key must be a text, not {}", key.words()));
    } else if (key.text == "<<" && !key.quoted) {
      found_.error("E004", key.place, {},
                   "merge keys '<<' are not part of YAML 1.2 and not supported",
                   "repeat the keys, or use 'include'");
    } else if (const Entry* first = top.node.find(key.text)) {
      found_.error("E003", key.place, {}, fmt::format("duplicate key '{}'", key.text),
                   fmt::format("it is already given in line {}", first->place.line));
    } else {
      top.keep = true;
    }
  }

  std::string name_;
  Diagnostics& found_;
  YamlLimits limits_;
  Node root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Node> anchored_;
  int nodes_ = 0;
  std::size_t bytes_ = 0;
};

/// The place of a byte of the text.
Place place_of_byte(std::string_view text, std::size_t at, const std::string& name) {
  const std::string_view before = text.substr(0, at);
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 = 0
  return {name, static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
          static_cast<int>(at - line_start) + 1};
}

/// Bytes that YAML does not allow, or that are no UTF-8; the library would take some of them for
/// the end of the text and replace others.
bool is_no_text(std::string_view text, const std::string& name, Diagnostics& found) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    found.error("E002", {name, 1, 1}, {}, "the file is not UTF-8 but UTF-16", "save it as UTF-8");
    return true;
  }
  const auto control = std::find_if(text.begin(), text.end(), is_control);
  if (control != text.end()) {
    const auto at = static_cast<std::size_t>(control - text.begin());
    found.error("E002", place_of_byte(text, at, name), {},
                fmt::format("not a text file: it contains the byte {}",
                            static_cast<int>(static_cast<unsigned char>(*control))));
    return true;
  }
  if (const std::size_t at = invalid_utf8(text); at != std::string_view::npos) {
    found.error("E002", place_of_byte(text, at, name), {},
                fmt::format("the file is not UTF-8: it contains the byte 0x{:02X} here",
                            static_cast<unsigned char>(text[at])),
                "save it as UTF-8");
    return true;
  }
  return false;
}

/// Input for which the library needs much memory before the builder can count its values.
bool is_too_dense(std::string_view text, const std::string& name, const YamlLimits& limits,
                  Diagnostics& found) {
  std::size_t punctuation = 0;
  int line = 1;
  for (std::size_t start = 0; start < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    if (end - start > limits.line) {
      found.error(
          "E006", {name, line, 1}, {},
          fmt::format("a line of {} bytes; at most {} are allowed", end - start, limits.line),
          "break it into lines; put large tables into a CSV file");
      return true;
    }
    for (std::size_t k = start; k < end; ++k) {
      if (std::string_view("[]{},").find(text[k]) == std::string_view::npos ||
          ++punctuation <= limits.punctuation)
        continue;
      found.error(
          "E006", {name, line, static_cast<int>(k - start) + 1}, {},
          fmt::format("the deck has more than {} brackets, braces and commas", limits.punctuation),
          "put large tables into a CSV file");
      return true;
    }
    start = end + 1;
  }
  return false;
}

}  // namespace

std::optional<Node> read_yaml(const std::string& text, const std::string& name, Diagnostics& found,
                              const YamlLimits& limits) {
  if (text.size() > limits.bytes) {
    found.error("E006", {name, 0, 0}, {},
                fmt::format("the deck is larger than {} bytes", limits.bytes),
                "put large tables into a CSV file");
    return std::nullopt;
  }
  if (is_no_text(text, name, found) || is_too_dense(text, name, limits, found)) return std::nullopt;
  Builder builder(name, found, limits);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    parser.HandleNextDocument(builder);
    Node root = builder.take();
    if (root.place.file.empty()) root.place = {name, 1, 1};
    Builder second(name, found, limits);
    if (parser.HandleNextDocument(second)) {
      found.error("E005", second.take().place, {}, "the deck has a second document",
                  "keep one document per file; combine files with 'include'");
    }
    return root;
  } catch (const YAML::Exception& e) {
    const bool nowhere = e.mark.is_null();
    const Place at{name, nowhere ? 0 : e.mark.line + 1, nowhere ? 0 : e.mark.column + 1};
    found.error("E002", at, {}, "not valid YAML: " + e.msg,
                text.find('\t') != std::string::npos ? "indent with blanks, not with tabs" : "");
  } catch (const Stop&) {
  }
  return std::nullopt;
}

std::optional<std::string> read_text_file(const std::string& path, const Place& named_at,
                                          Diagnostics& found, bool only_regular,
                                          std::size_t limit) {
  const auto read_all = [&](std::istream& in) -> std::optional<std::string> {
    std::string text;
    std::array<char, 1 << 16> block;
    while (in.read(block.data(), block.size()), in.gcount() > 0) {
      text.append(block.data(), static_cast<std::size_t>(in.gcount()));
      if (text.size() <= limit) continue;
      found.error("E006", named_at, {}, fmt::format("'{}' is larger than {} bytes", path, limit),
                  "put large tables into a CSV file");
      return std::nullopt;
    }
    return text;
  };
  if (path == "-") return read_all(std::cin);
  std::error_code problem;
  const std::filesystem::file_status status = std::filesystem::status(path, problem);
  std::string why;
  if (std::filesystem::is_directory(status)) {
    why = "it is a folder";
  } else if (only_regular && std::filesystem::exists(status) &&
             !std::filesystem::is_regular_file(status)) {
    why = "it is not a regular file";
  } else {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (in) {
      std::optional<std::string> text = read_all(in);
      if (!in.bad()) return text;
    }
    why = errno != 0 ? std::strerror(errno) : "unknown reason";
  }
  found.error("E001", named_at, {}, fmt::format("cannot read '{}': {}", path, why));
  return std::nullopt;
}

}  // namespace sphgeo
