#include "output/vtu.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "output/vtu_array.h"

namespace sphgeo {

static_assert(std::endian::native == std::endian::little, "the head says LittleEndian");

namespace {

constexpr int vtk_vertex = 1;
constexpr int vtk_line = 3;
constexpr int vtk_triangle = 5;

template <class T>
const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  else if constexpr (std::is_same_v<T, float>) return "Float32";
  else if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  else if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  else if constexpr (std::is_same_v<T, std::uint64_t>) return "UInt64";
  else return "UInt8";
}

template <class T>
std::string array_head(const std::string& name, int components) {
  return fmt::format(R"(type="{}" Name="{}" NumberOfComponents="{}")", vtk_type<T>(),
                     xml_escaped(name), components);
}

/// An array of T from values of another (or the same) type.
template <class T, class From>
VtuArray converted(const VtuField& field, std::span<const From> data, bool compress) {
  return VtuArray::make<T>(array_head<T>(field.name, field.components),
                           static_cast<Index>(data.size()), compress,
                           [data](Index first, Index n, T* out) {
                             for (Index i = 0; i < n; ++i)
                               out[i] = static_cast<T>(data[static_cast<std::size_t>(first + i)]);
                           });
}

VtuArray field_array(const VtuField& field, Index tuples, const VtuOptions& options) {
  return std::visit(
      [&](auto data) {
        using T = std::remove_const_t<typename decltype(data)::element_type>;
        if (field.components < 1 ||
            static_cast<Index>(data.size()) != tuples * static_cast<Index>(field.components))
          throw std::invalid_argument(fmt::format("field '{}': {} values for {} x {}", field.name,
                                                  data.size(), tuples, field.components));
        if constexpr (std::is_same_v<T, double>) {
          if (options.precision == VtuPrecision::float32)
            return converted<float>(field, data, options.compress);
        }
        return converted<T>(field, data, options.compress);
      },
      field.data);
}

template <class T>
VtuArray point_array(const VtuPoints& points, bool compress) {
  return VtuArray::make<T>(array_head<T>("Points", 3), 3 * points.count(), compress,
                           [&points](Index first, Index n, T* out) {
                             for (Index k = first; k < first + n; ++k)
                               out[k - first] = static_cast<T>(points(k / 3)[k % 3]);
                           });
}

/// Numbers that follow from their place: offsets and, for vertices, the connectivity. 32 bits while
/// they suffice.
VtuArray counted_array(const std::string& name, Index count, Index largest, bool compress,
                       std::function<Index(Index)> value) {
  const auto make = [&]<class T>(T) {
    return VtuArray::make<T>(array_head<T>(name, 1), count, compress,
                             [value](Index first, Index n, T* out) {
                               for (Index i = 0; i < n; ++i)
                                 out[i] = static_cast<T>(value(first + i));
                             });
  };
  return largest <= std::numeric_limits<std::int32_t>::max() ? make(std::int32_t{})
                                                             : make(std::int64_t{});
}

/// The XML head with the offsets, and the arrays in the order of their offsets.
class VtuFile {
 public:
  explicit VtuFile(const VtuOptions& options) : options_(options) {}

  void open(const std::string& element) { xml_ += fmt::format("      <{}>\n", element); }
  void close(const std::string& element) { xml_ += fmt::format("      </{}>\n", element); }

  void add(VtuArray array, const std::string& unit = {}) {
    xml_ += fmt::format(R"(        <DataArray {} format="appended" offset="{}")", array.head(),
                        offset_);
    if (unit.empty() || unit == "1") xml_ += "/>\n";
    else
      xml_ += fmt::format(
          "><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey>"
          "</DataArray>\n",
          xml_escaped(unit));
    offset_ += array.bytes();
    arrays_.push_back(std::move(array));
  }

  void add_fields(const std::string& element, const std::vector<VtuField>& fields, Index tuples) {
    open(element);
    for (const VtuField& f : fields) add(field_array(f, tuples, options_), f.unit);
    close(element);
  }

  std::uint64_t bytes(Index points, Index cells) const {
    return head(points, cells).size() + offset_ + tail.size();
  }

  FileImage image(Index points, Index cells) const {
    const std::string start = head(points, cells);
    FileImage file(start.size() + offset_ + tail.size());
    unsigned char* to = std::copy(start.begin(), start.end(), file.data());
    for (const VtuArray& a : arrays_) {
      a.store(to);
      to += a.bytes();
    }
    std::copy(tail.begin(), tail.end(), to);
    return file;
  }

 private:
  static constexpr std::string_view tail = "\n  </AppendedData>\n</VTKFile>\n";

  /// All that stands before the first array.
  std::string head(Index points, Index cells) const {
    std::string text =
        "<?xml version=\"1.0\"?>\n<!-- written by sphgeo -->\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\"";
    if (options_.compress) text += " compressor=\"vtkZLibDataCompressor\"";
    text += ">\n  <UnstructuredGrid>\n";
    if (options_.time)
      text += fmt::format(
          "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" "
          "NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n    </FieldData>\n",
          *options_.time);
    text += fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", points, cells);
    text += xml_;
    text += "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_";
    return text;
  }

  VtuOptions options_;
  std::string xml_;
  std::uint64_t offset_ = 0;
  std::vector<VtuArray> arrays_;
};

VtuFile grid_file(const VtuPoints& points, int corners_per_cell, Index cells,
                  const std::function<Index(Index)>& corner,
                  const std::vector<VtuField>& point_fields,
                  const std::vector<VtuField>& cell_fields, const VtuOptions& options) {
  VtuFile file(options);
  file.add_fields("PointData", point_fields, points.count());
  file.add_fields("CellData", cell_fields, cells);
  file.open("Points");
  file.add(options.precision == VtuPrecision::float32
               ? point_array<float>(points, options.compress)
               : point_array<double>(points, options.compress),
           "m");
  file.close("Points");

  const Index corners = cells * corners_per_cell;
  const int type = corners_per_cell == 1   ? vtk_vertex
                   : corners_per_cell == 2 ? vtk_line
                                           : vtk_triangle;
  file.open("Cells");
  file.add(counted_array("connectivity", corners, points.count(), options.compress, corner));
  file.add(counted_array("offsets", cells, corners, options.compress,
                         [corners_per_cell](Index i) { return (i + 1) * corners_per_cell; }));
  file.add(VtuArray::make<std::uint8_t>(array_head<std::uint8_t>("types", 1), cells,
                                        options.compress,
                                        [type](Index, Index n, std::uint8_t* out) {
                                          std::fill(out, out + n, static_cast<std::uint8_t>(type));
                                        }));
  file.close("Cells");
  return file;
}

VtuFile particles_file(const VtuPoints& points, const std::vector<VtuField>& fields,
                       const VtuOptions& options) {
  return grid_file(
      points, 1, points.count(), [](Index i) { return i; }, fields, {}, options);
}

VtuFile mesh_file(const VtuPoints& points, int corners_per_cell, std::span<const Index> corners,
                  const std::vector<VtuField>& point_fields,
                  const std::vector<VtuField>& cell_fields, const VtuOptions& options) {
  const auto count = static_cast<Index>(corners.size());
  if ((corners_per_cell != 2 && corners_per_cell != 3) || count % corners_per_cell != 0)
    throw std::invalid_argument("a mesh needs 2 or 3 corners a cell");
  for (const Index c : corners)
    if (c < 0 || c >= points.count()) throw std::invalid_argument("a mesh corner is not a point");
  return grid_file(
      points, corners_per_cell, count / corners_per_cell,
      [corners](Index i) { return corners[static_cast<std::size_t>(i)]; }, point_fields,
      cell_fields, options);
}

}  // namespace

FileImage vtu_image(const VtuPoints& points, const std::vector<VtuField>& fields,
                    const VtuOptions& options) {
  return particles_file(points, fields, options).image(points.count(), points.count());
}

void write_vtu(const std::string& path, const VtuPoints& points,
               const std::vector<VtuField>& fields, const VtuOptions& options) {
  vtu_image(points, fields, options).write(path);
}

std::uint64_t vtu_bytes(const VtuPoints& points, const std::vector<VtuField>& fields,
                        const VtuOptions& options) {
  return particles_file(points, fields, options).bytes(points.count(), points.count());
}

FileImage vtu_mesh_image(const VtuPoints& points, int corners_per_cell,
                         std::span<const Index> corners, const std::vector<VtuField>& point_fields,
                         const std::vector<VtuField>& cell_fields, const VtuOptions& options) {
  return mesh_file(points, corners_per_cell, corners, point_fields, cell_fields, options)
      .image(points.count(), static_cast<Index>(corners.size()) / corners_per_cell);
}

void write_vtu_mesh(const std::string& path, const VtuPoints& points, int corners_per_cell,
                    std::span<const Index> corners, const std::vector<VtuField>& point_fields,
                    const std::vector<VtuField>& cell_fields, const VtuOptions& options) {
  vtu_mesh_image(points, corners_per_cell, corners, point_fields, cell_fields, options).write(path);
}

std::uint64_t vtu_mesh_bytes(const VtuPoints& points, int corners_per_cell,
                             std::span<const Index> corners,
                             const std::vector<VtuField>& point_fields,
                             const std::vector<VtuField>& cell_fields, const VtuOptions& options) {
  return mesh_file(points, corners_per_cell, corners, point_fields, cell_fields, options)
      .bytes(points.count(), static_cast<Index>(corners.size()) / corners_per_cell);
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace sphgeo
