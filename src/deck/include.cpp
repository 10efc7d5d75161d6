// `include:` of other deck files.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/text.h"
#include "deck/deck_file.h"
#include "deck/yaml_reader.h"

namespace sphgeo {

namespace {

namespace fs = std::filesystem;

bool is_list_of_mappings(const Node& node) {
  return node.kind == Node::Kind::list &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const Node& item) { return item.kind == Node::Kind::map; });
}

std::string at_words(const Place& p) { return fmt::format("{}:{}", p.file, p.line); }

/// Adds the entries of `from` to `into`.
void merge(Node& into, Node from, const std::string& path, Diagnostics& found) {
  for (Entry& e : from.entries) {
    Entry* there = into.find(e.key);
    if (there == nullptr) {
      into.entries.push_back(std::move(e));
      continue;
    }
    const std::string at = join_path(path, e.key);
    if (there->value.kind == Node::Kind::map && e.value.kind == Node::Kind::map) {
      merge(there->value, std::move(e.value), at, found);
    } else if (is_list_of_mappings(there->value) && is_list_of_mappings(e.value)) {
      std::move(e.value.items.begin(), e.value.items.end(), std::back_inserter(there->value.items));
    } else if (e.key.rfind("x-", 0) != 0) {
      found.error("E007", e.place, path, fmt::format("'{}' is given in two files", at),
                  fmt::format("it is already given in {}; to change it for one run use --set",
                              at_words(there->place)));
    }
  }
}

class Includer {
 public:
  explicit Includer(Diagnostics& found) : found_(found) {}

  std::optional<Node> read(const DeckText& deck, const std::string& identity) {
    found_.keep_source(deck.name, deck.text);
    std::optional<Node> own = read_yaml(deck.text, deck.name, found_);
    if (!own) return std::nullopt;
    if (own->kind != Node::Kind::map) {
      found_.error("E010", own->place, {},
                   own->kind == Node::Kind::null
                       ? "the deck is empty"
                       : fmt::format("expected a mapping of deck sections, got {}", own->words()));
      return std::nullopt;
    }
    const Entry* include = own->find("include");
    if (include == nullptr) return own;
    const Entry files = *include;
    own->entries.erase(own->entries.begin() + (include - own->entries.data()));
    if (files.value.kind != Node::Kind::list) {
      found_.error("E010", files.value.place, "include",
                   fmt::format("expected a list of files, got {}", files.value.words()),
                   "write include: [other.yaml]");
      return own;
    }
    Node merged = Node::map();
    merged.place = own->place;
    open_.push_back(identity);
    for (const Node& file : files.value.items) {
      if (std::optional<Node> part = read_included(file, deck.folder)) {
        merge(merged, std::move(*part), {}, found_);
      }
    }
    open_.pop_back();
    merge(merged, std::move(*own), {}, found_);
    return merged;
  }

 private:
  std::optional<Node> read_included(const Node& file, const std::string& folder) {
    if (file.kind != Node::Kind::scalar || trimmed(file.text).empty()) {
      found_.error("E010", file.place, "include",
                   fmt::format("expected the name of a file, got {}", file.words()));
      return std::nullopt;
    }
    const fs::path path = (fs::path(folder) / file.text).lexically_normal();
    std::error_code problem;
    const std::string identity = fs::weakly_canonical(path, problem).string();
    if (std::find(open_.begin(), open_.end(), identity) != open_.end()) {
      found_.error("E007", file.place, "include", fmt::format("'{}' includes itself", file.text),
                   "an included file may not lead back to the file that includes it");
      return std::nullopt;
    }
    if (std::find(done_.begin(), done_.end(), identity) != done_.end()) {
      found_.error("E007", file.place, "include", fmt::format("'{}' is included twice", file.text),
                   "include it in one place");
      return std::nullopt;
    }
    if (open_.size() > deepest || done_.size() >= most_files) {
      found_.error(
          "E006", file.place, "include",
          open_.size() > deepest
              ? fmt::format("included files include others more than {} levels deep", deepest)
              : fmt::format("the deck includes more than {} files", most_files));
      return std::nullopt;
    }
    done_.push_back(identity);
    const std::optional<std::string> text = read_text_file(path.string(), file.place, found_, true);
    if (!text) return std::nullopt;
    return read({path.string(), path.parent_path().string(), *text}, identity);
  }

  static constexpr std::size_t deepest = 20;
  static constexpr std::size_t most_files = 200;

  Diagnostics& found_;
  std::vector<std::string> open_;  // files on the way to the present one
  std::vector<std::string> done_;
};

}  // namespace

std::optional<Node> read_deck_tree(const DeckText& deck, Diagnostics& found) {
  std::error_code problem;
  const fs::path own = fs::path(deck.folder) / fs::path(deck.name).filename();
  return Includer(found).read(deck, fs::weakly_canonical(own, problem).string());
}

}  // namespace sphgeo
