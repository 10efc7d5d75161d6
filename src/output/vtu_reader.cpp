#include "output/vtu_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"

namespace sphgeo {

namespace {

/// No block deflates to less than this fraction of its size.
constexpr std::uint64_t most_deflation = 1032;

/// One tag of the head with its attributes, as it stands in the text.
struct Tag {
  std::string_view text;   ///< between < and >
  std::string_view after;  ///< up to the next <

  bool is(std::string_view name) const { return text.substr(0, text.find_first_of(" />")) == name; }
};

/// The XML part of a file and where its binary part lies.
class Head {
 public:
  Head(std::string_view file, std::string path) : path_(std::move(path)) {
    constexpr std::string_view mark = "<AppendedData encoding=\"raw\">\n_";
    const auto end = file.find(mark);
    if (!file.starts_with("<?xml") || end == std::string_view::npos)
      fail("is not a frame of sphgeo: it has no appended raw data");
    text_ = file.substr(0, end);
    data_ = file.substr(end + mark.size());
  }

  [[noreturn]] void fail(const std::string& what) const { throw IoError(path_, what); }
  std::string_view data() const { return data_; }

  /// The tag from `at` on; moves `at` behind it. Empty at the end.
  std::optional<Tag> next(std::size_t& at) const {
    at = text_.find('<', at);
    if (at == std::string_view::npos) return {};
    const auto end = text_.find('>', at);
    if (end == std::string_view::npos) fail("is damaged: a tag without an end");
    Tag tag{text_.substr(at + 1, end - at - 1), {}};
    const auto following = std::min(text_.find('<', end), text_.size());
    tag.after = text_.substr(end + 1, following - end - 1);
    at = end + 1;
    return tag;
  }

  /// The value of an attribute, its escapes undone; empty optional when the tag has none.
  std::optional<std::string> attribute(const Tag& tag, std::string_view name) const {
    const std::string key = fmt::format(" {}=\"", name);
    const auto begin = tag.text.find(key);
    if (begin == std::string_view::npos) return {};
    const auto end = tag.text.find('"', begin + key.size());
    if (end == std::string_view::npos) fail("is damaged: an attribute without an end");
    return unescaped(tag.text.substr(begin + key.size(), end - begin - key.size()));
  }

  std::string needed(const Tag& tag, std::string_view name) const {
    if (auto value = attribute(tag, name)) return *value;
    fail(fmt::format("is damaged: <{}> has no '{}'", shortened(printable(tag.text), 40), name));
  }

  std::uint64_t count(const Tag& tag, std::string_view name) const {
    const std::string text = needed(tag, name);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      fail(fmt::format("is damaged: '{}' is not a number", shortened(printable(text), 40)));
    return value;
  }

  static std::string unescaped(std::string_view escaped) {
    std::string value(escaped);
    for (const auto& [escape, character] : {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"},
                                            std::pair{"&quot;", "\""}, std::pair{"&amp;", "&"}})
      for (auto at = value.find(escape); at != std::string::npos; at = value.find(escape, at + 1))
        value.replace(at, std::strlen(escape), character);
    return value;
  }

 private:
  std::string path_;
  std::string_view text_, data_;
};

/// An array as the head describes it.
struct ArrayPlace {
  std::string section, type, name, unit;
  std::uint64_t components = 1, offset = 0;
};

struct Layout {
  bool compressed = false;
  std::uint64_t points = 0, cells = 0;
  std::optional<double> time;
  std::vector<ArrayPlace> arrays;
};

constexpr std::string_view sections[] = {"PointData", "CellData", "Points", "Cells"};

void read_file_tag(const Head& head, const Tag& tag, Layout& layout) {
  if (head.needed(tag, "type") != "UnstructuredGrid") head.fail("is not an unstructured grid");
  if (head.needed(tag, "byte_order") != "LittleEndian" ||
      head.needed(tag, "header_type") != "UInt64")
    head.fail("was not written by sphgeo: another byte order, or another type of the sizes");
  const std::optional<std::string> compressor = head.attribute(tag, "compressor");
  if (compressor && *compressor != "vtkZLibDataCompressor")
    head.fail("was not written by sphgeo: another compressor");
  layout.compressed = compressor.has_value();
}

Layout layout_of(const Head& head) {
  Layout layout;
  std::string section;
  bool grid = false, piece = false;
  std::size_t at = 0;
  while (const std::optional<Tag> tag = head.next(at)) {
    if (tag->is("VTKFile")) {
      read_file_tag(head, *tag, layout);
      grid = true;
    } else if (tag->is("Piece")) {
      if (piece) head.fail("has several pieces: not written by sphgeo");
      piece = true;
      layout.points = head.count(*tag, "NumberOfPoints");
      layout.cells = head.count(*tag, "NumberOfCells");
    } else if (tag->is("DataArray") && section.empty()) {
      if (head.attribute(*tag, "Name") != "TimeValue") continue;
      double time = 0;
      const auto [end, error] =
          std::from_chars(tag->after.data(), tag->after.data() + tag->after.size(), time);
      if (error != std::errc{} || end != tag->after.data() + tag->after.size())
        head.fail("is damaged: its time is not a number");
      layout.time = time;
    } else if (tag->is("DataArray")) {
      if (head.needed(*tag, "format") != "appended")
        head.fail("was not written by sphgeo: an array that is not appended");
      ArrayPlace array{section,
                       head.needed(*tag, "type"),
                       head.needed(*tag, "Name"),
                       {},
                       head.count(*tag, "NumberOfComponents"),
                       head.count(*tag, "offset")};
      if (array.components < 1 || array.components > 9)
        head.fail(fmt::format("is damaged: array '{}' has {} components", printable(array.name),
                              array.components));
      layout.arrays.push_back(std::move(array));
    } else if (tag->is("InformationKey") && !layout.arrays.empty() &&
               head.attribute(*tag, "name") == "UNITS_LABEL") {
      layout.arrays.back().unit = Head::unescaped(tag->after);
    } else {
      for (const std::string_view name : sections) {
        if (tag->is(name)) section = name;
        if (tag->text == "/" + std::string(name)) section.clear();
      }
    }
  }
  if (!grid || !piece) head.fail("is damaged: no grid in it");
  return layout;
}

/// The appended arrays; every size is checked against what the file holds before it is used.
class Arrays {
 public:
  Arrays(const Head& head, bool compressed, std::uint64_t most_bytes)
      : head_(head), compressed_(compressed), left_(most_bytes) {}

  std::vector<double> operator()(const ArrayPlace& place, std::uint64_t tuples) {
    if (place.type == "Float64") return values<double>(place, tuples);
    if (place.type == "Float32") return values<float>(place, tuples);
    if (place.type == "Int32") return values<std::int32_t>(place, tuples);
    if (place.type == "Int64") return values<std::int64_t>(place, tuples);
    if (place.type == "UInt64") return values<std::uint64_t>(place, tuples);
    if (place.type == "UInt8") return values<std::uint8_t>(place, tuples);
    head_.fail(fmt::format("was not written by sphgeo: array '{}' of type '{}'",
                           printable(place.name), printable(place.type)));
  }

 private:
  template <class T>
  std::vector<double> values(const ArrayPlace& place, std::uint64_t tuples) {
    constexpr std::uint64_t safe = std::numeric_limits<std::uint64_t>::max() / 1000;
    if (tuples > safe || tuples * place.components * sizeof(double) > left_)
      head_.fail(fmt::format("would take too much memory: array '{}' of {} x {} values",
                             printable(place.name), tuples, place.components));
    const std::uint64_t count = tuples * place.components;
    left_ -= count * sizeof(double);
    const std::string raw =
        compressed_ ? inflated(place, count * sizeof(T)) : plain(place, count * sizeof(T));
    std::vector<double> out(count);
    parallel_for(static_cast<Index>(count), [&](Index k) {
      const auto i = static_cast<std::size_t>(k);
      T value;
      std::memcpy(&value, raw.data() + i * sizeof(T), sizeof(T));
      out[i] = static_cast<double>(value);
    });
    return out;
  }

  [[noreturn]] void damaged(const ArrayPlace& place, std::string_view why) const {
    head_.fail(fmt::format("is damaged: array '{}' {}", printable(place.name), why));
  }

  std::uint64_t size_at(const ArrayPlace& place, std::uint64_t at) const {
    std::uint64_t value = 0;
    if (at > head_.data().size() || head_.data().size() - at < sizeof value)
      damaged(place, "lies beyond the end of the file");
    std::memcpy(&value, head_.data().data() + at, sizeof value);
    return value;
  }

  std::string plain(const ArrayPlace& place, std::uint64_t bytes) const {
    if (size_at(place, place.offset) != bytes)
      damaged(place, "is not as long as there are points or cells");
    const std::uint64_t begin = place.offset + sizeof bytes;
    if (head_.data().size() - begin < bytes) damaged(place, "lies beyond the end of the file");
    return std::string(head_.data().substr(begin, bytes));
  }

  std::string inflated(const ArrayPlace& place, std::uint64_t bytes) const {
    const std::uint64_t blocks = size_at(place, place.offset);
    const std::uint64_t size = size_at(place, place.offset + 8),
                        last = size_at(place, place.offset + 16);
    const std::uint64_t space = head_.data().size();
    if (blocks > space / 8) damaged(place, "has more blocks than fit into the file");
    if (bytes / most_deflation > space) damaged(place, "is longer than the file can hold");
    const std::uint64_t full = blocks - (last > 0 && blocks > 0 ? 1 : 0);
    if (size > bytes + 65536 * 16 || last > size || full * size + last != bytes) {
      if (blocks != 0 || bytes != 0) damaged(place, "is not as long as there are points or cells");
    }
    std::string out(bytes, '\0');
    // Where each block begins in the file; the last of them may end beyond it.
    std::vector<std::uint64_t> from{place.offset + 24 + 8 * blocks};
    const auto packed = [&](std::uint64_t b) { return size_at(place, place.offset + 24 + 8 * b); };
    const auto whole = [&](std::uint64_t b) {
      return from[b] <= space && packed(b) <= space - from[b];
    };
    while (from.size() <= blocks && whole(from.size() - 1))
      from.push_back(from.back() + packed(from.size() - 1));
    const auto here = std::min<std::uint64_t>(from.size(), blocks);
    parallel_blocks(static_cast<Index>(here), 1, [&](Index block, Index, Index) {
      const auto b = static_cast<std::uint64_t>(block);
      if (!whole(b)) damaged(place, "lies beyond the end of the file");
      const std::uint64_t wanted = b < full ? size : last;
      auto length = static_cast<uLongf>(wanted);
      const auto* source = reinterpret_cast<const Bytef*>(head_.data().data() + from[b]);
      if (uncompress(reinterpret_cast<Bytef*>(out.data() + b * size), &length, source,
                     static_cast<uLong>(packed(b))) != Z_OK ||
          length != wanted)
        damaged(place, fmt::format("cannot be unpacked (block {} of {})", b + 1, blocks));
    });
    return out;
  }

  const Head& head_;
  bool compressed_;
  std::uint64_t left_;  ///< bytes that may still be taken
};

void read_corners(const Head& head, Arrays& arrays, const ArrayPlace* connectivity,
                  const ArrayPlace* types, const Layout& layout, VtuFrame& frame) {
  if (!connectivity || !types) head.fail("is damaged: its cells are not described");
  if (layout.cells == 0) return;
  const std::vector<double> kinds = arrays(*types, layout.cells);
  const int corners = kinds[0] == 1 ? 1 : kinds[0] == 3 ? 2 : kinds[0] == 5 ? 3 : 0;
  for (const double k : kinds)
    if (corners == 0 || k != kinds[0])
      head.fail(
          "was not written by sphgeo: cells other than points, lines or triangles, or mixed ones");
  frame.corners_per_cell = corners;
  if (corners == 1) return;
  const std::vector<double> numbers =
      arrays(*connectivity, layout.cells * static_cast<std::uint64_t>(corners));
  frame.corners.reserve(numbers.size());
  for (const double c : numbers) {
    if (!(c >= 0 && c < static_cast<double>(layout.points)))
      head.fail("is damaged: the corner of a cell is not a point");
    frame.corners.push_back(static_cast<Index>(c));
  }
}

}  // namespace

double VtuColumn::magnitude(std::size_t tuple) const {
  const auto n = static_cast<std::size_t>(components);
  if (n == 1) return values[tuple];
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) sum += values[n * tuple + k] * values[n * tuple + k];
  return std::sqrt(sum);
}

const VtuColumn* VtuFrame::find(std::string_view name) const {
  for (const VtuColumn& c : point_fields)
    if (c.name == name) return &c;
  return nullptr;
}

VtuFrame read_vtu(const std::string& path, const VtuReading& reading) {
  const std::string file = read_file(path, reading.most_bytes);
  const Head head(file, path);
  const Layout layout = layout_of(head);
  Arrays arrays(head, layout.compressed, reading.most_bytes);
  VtuFrame frame;
  frame.time = layout.time;
  const ArrayPlace *places = nullptr, *connectivity = nullptr, *types = nullptr;
  for (const ArrayPlace& a : layout.arrays) {
    if (a.section == "Points") places = &a;
    if (a.section == "Cells" && a.name == "connectivity") connectivity = &a;
    if (a.section == "Cells" && a.name == "types") types = &a;
    const bool of_cells = a.section == "CellData";
    if ((!of_cells && a.section != "PointData") || (reading.wanted && !reading.wanted(a.name)))
      continue;
    VtuColumn column{a.name, a.unit, static_cast<int>(a.components),
                     arrays(a, of_cells ? layout.cells : layout.points)};
    (of_cells ? frame.cell_fields : frame.point_fields).push_back(std::move(column));
  }
  if (!places || places->components != 3) head.fail("is damaged: it has no points");
  const std::vector<double> x = arrays(*places, layout.points);
  frame.points.reserve(layout.points);
  for (std::size_t i = 0; i < x.size(); i += 3) frame.points.emplace_back(x[i], x[i + 1], x[i + 2]);
  read_corners(head, arrays, connectivity, types, layout, frame);
  return frame;
}

std::vector<VtuColumn> vtu_fields(const std::string& path) {
  const std::string file = read_file(path);
  const Head head(file, path);
  std::vector<VtuColumn> fields;
  for (const ArrayPlace& a : layout_of(head).arrays)
    if (a.section == "PointData")
      fields.push_back({a.name, a.unit, static_cast<int>(a.components), {}});
  return fields;
}

}  // namespace sphgeo
