#include "deck/yaml_reader.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

namespace sphgeo {

namespace {

/// Ends the reading after an error that was already reported.
struct Stop {};

int count_nodes(const Node& node) {
  int n = 1;
  for (const Node& item : node.items) n += count_nodes(item);
  for (const Entry& e : node.entries) n += count_nodes(e.value);
  return n;
}

/// Builds the tree from the parser's events, which show keys and aliases with their own marks; the
/// library's own tree has lost both.
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
    count(count_nodes(copy), copy.place);
    finish(std::move(copy), 0);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node = Node::scalar(value, tag == "!");
    node.place = place(mark);
    refuse_tag(tag, node.place);
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
                 "leave the tag out");
  }

  void count(int nodes, const Place& at) {
    nodes_ += nodes;
    if (nodes_ <= limits_.nodes) return;
    found_.error("E006", at, {}, fmt::format("the deck has more than {} values", limits_.nodes),
                 "put large tables into a CSV file");
    throw Stop{};
  }

  void begin(Node node, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    node.place = place(mark);
    refuse_tag(tag, node.place);
    if (static_cast<int>(open_.size()) >= limits_.depth) {
      found_.error("E006", node.place, {},
                   fmt::format("the deck is nested more than {} levels deep", limits_.depth));
      throw Stop{};
    }
    open_.push_back({std::move(node), anchor, false, true, {}, {}});
  }

  void end() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done.node), done.anchor);
  }

  void finish(Node node, YAML::anchor_t anchor) {
    count(1, node.place);
    if (anchor != 0) anchored_[anchor] = node;
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
};

/// Bytes that YAML does not allow; the library would take some of them for the end of the text.
bool has_control_characters(const std::string& text, const std::string& name, Diagnostics& found) {
  int line = 1;
  int column = 1;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      column = 1;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\t' && c != '\r') || byte == 0x7f) {
      found.error("E002", {name, line, column}, {},
                  fmt::format("not a text file: it holds the byte {}", static_cast<int>(byte)));
      return true;
    }
    ++column;
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
  if (has_control_characters(text, name, found)) return std::nullopt;
  Builder builder(name, found, limits);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    parser.HandleNextDocument(builder);
    Node root = builder.take();
    if (root.place.file.empty()) root.place = {name, 1, 1};
    Builder second(name, found, limits);
    if (parser.HandleNextDocument(second)) {
      found.error("E005", second.take().place, {}, "the deck holds a second document",
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
                                          Diagnostics& found) {
  const auto read_all = [](std::istream& in) {
    return std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  };
  if (path == "-") return read_all(std::cin);
  std::error_code problem;
  std::string why;
  if (std::filesystem::is_directory(path, problem)) {
    why = "it is a folder";
  } else {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (in) {
      std::string text = read_all(in);
      if (!in.bad()) return text;
    }
    why = errno != 0 ? std::strerror(errno) : "unknown reason";
  }
  found.error("E001", named_at, {}, fmt::format("cannot read '{}': {}", path, why));
  return std::nullopt;
}

}  // namespace sphgeo
