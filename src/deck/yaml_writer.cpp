#include "deck/yaml_writer.h"

#include <algorithm>
#include <string_view>

namespace sphgeo {

namespace {

bool is_plain(const std::string& text) {
  constexpr std::string_view letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  constexpr std::string_view inside = "./+*^()<>=- ";
  if (text.empty() || text.back() == ' ') return false;
  if (letters.find(text[0]) == std::string_view::npos && text[0] != '(' && text[0] != '/' &&
      !((text[0] == '-' || text[0] == '.') && text.size() > 1 && text[1] != ' ' &&
        text[1] != '-')) {
    return false;
  }
  return std::all_of(text.begin(), text.end(), [&](char c) {
    return letters.find(c) != std::string_view::npos || inside.find(c) != std::string_view::npos;
  });
}

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') out += "\\n";
    else if (c == '\t') out += "\\t";
    else if (c == '\r') out += "\\r";
    else out += c;
  }
  return out + '"';
}

std::string scalar(const Node& node) {
  if (node.kind == Node::Kind::null) return "null";
  return !node.quoted && is_plain(node.text) ? node.text : in_quotes(node.text);
}

bool is_short(const Node& node) {
  return node.kind == Node::Kind::scalar || node.kind == Node::Kind::null ||
         (node.kind == Node::Kind::map && node.entries.empty()) ||
         (node.kind == Node::Kind::list &&
          std::all_of(node.items.begin(), node.items.end(), is_short));
}

/// In one line, for values where `is_short`.
std::string one_line(const Node& node) {
  if (node.kind == Node::Kind::map) return "{}";
  if (node.kind != Node::Kind::list) return scalar(node);
  std::string out = "[";
  for (const Node& item : node.items) {
    if (out.size() > 1) out += ", ";
    out += one_line(item);
  }
  return out + "]";
}

void write(std::string& out, const Node& node, int indent);

/// `lead` is what stands before the value in its line: "key:" or "-".
void write_after(std::string& out, const std::string& lead, const Node& node, int indent) {
  out += lead;
  if (is_short(node)) {
    out += ' ' + one_line(node) + '\n';
    return;
  }
  if (lead == "-" && node.kind == Node::Kind::map) {
    // The first key of a list's mapping shares the line of the dash.
    std::string inner;
    write(inner, node, indent + 2);
    out += ' ' + inner.substr(static_cast<std::size_t>(indent) + 2);
    return;
  }
  out += '\n';
  write(out, node, indent + 2);
}

void write(std::string& out, const Node& node, int indent) {
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  if (is_short(node)) {
    out += blanks + one_line(node) + '\n';
    return;
  }
  for (const Entry& e : node.entries) {
    out += blanks;
    write_after(out, (is_plain(e.key) ? e.key : in_quotes(e.key)) + ":", e.value, indent);
  }
  for (const Node& item : node.items) {
    out += blanks;
    write_after(out, "-", item, indent);
  }
}

}  // namespace

std::string write_yaml(const Node& node) {
  std::string out;
  write(out, node, 0);
  return out;
}

}  // namespace sphgeo
