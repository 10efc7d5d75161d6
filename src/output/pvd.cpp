#include "output/pvd.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "output/vtu.h"

namespace sphgeo {

namespace {

/// The value of an attribute in one of our own lines, with the escapes undone.
std::string attribute(std::string_view line, std::string_view name, const std::string& path) {
  const std::string key = fmt::format(" {}=\"", name);
  const auto begin = line.find(key);
  const auto end = begin == std::string_view::npos ? begin : line.find('"', begin + key.size());
  if (end == std::string_view::npos)
    throw IoError(path,
                  fmt::format("a frame without '{}': not written by sphgeo, or damaged", name));
  std::string value(line.substr(begin + key.size(), end - begin - key.size()));
  for (const auto& [escape, character] : {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"},
                                          std::pair{"&quot;", "\""}, std::pair{"&amp;", "&"}})
    for (auto at = value.find(escape); at != std::string::npos; at = value.find(escape, at + 1))
      value.replace(at, std::string_view(escape).size(), character);
  return value;
}

}  // namespace

PvdFile PvdFile::read(const std::string& path) {
  PvdFile pvd(path);
  const std::string text = read_file(path);
  for (std::size_t at = text.find("<DataSet"); at != std::string::npos;
       at = text.find("<DataSet", std::min(text.size(), text.find('\n', at)))) {
    // Our own elements are one short line each.
    const std::string_view line = std::string_view(text).substr(at, text.find('\n', at) - at);
    if (line.find("/>") == std::string_view::npos)
      throw IoError(path, "a frame without an end: not written by sphgeo, or damaged");
    const std::string stamp = attribute(line, "timestep", path);
    double time = 0;
    const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), time);
    if (error != std::errc{} || end != stamp.data() + stamp.size() || !std::isfinite(time))
      throw IoError(path, fmt::format("the time '{}' is not a number", shortened(stamp, 60)));
    pvd.frames_.push_back({time, attribute(line, "file", path)});
  }
  return pvd;
}

PvdFile PvdFile::resume(const std::string& path, double last_time) {
  PvdFile pvd = read(path);
  pvd.truncate_after(last_time);
  return pvd;
}

void PvdFile::add(double time, const std::string& frame) {
  std::erase_if(frames_, [&](const Frame& f) { return f.time >= time; });
  frames_.push_back({time, frame});
  write();
}

void PvdFile::truncate_after(double last_time) {
  std::erase_if(frames_, [&](const Frame& f) { return f.time > last_time; });
  write();
}

void PvdFile::write() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<!-- written by sphgeo -->\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n";
  for (const Frame& f : frames_)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", f.time,
                        xml_escaped(f.file));
  text += "  </Collection>\n</VTKFile>\n";
  write_file_atomically(path_, text);
}

}  // namespace sphgeo
