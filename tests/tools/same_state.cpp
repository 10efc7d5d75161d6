// Compares two checkpoints array by array, but for the clocks in them:
//
//   sphgeo_same_state ONE TWO
//
// Exit 0 and the number of arrays and bytes that are the same, or 1 and the name of each array that
// differs.

#include <hdf5.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace {

using Arrays = std::map<std::string, std::vector<unsigned char>>;

// Clocks of the machine, and lengths of tables that hold such clocks.
bool is_clock(const std::string& name) {
  return name.find("seconds", name.rfind('/') + 1) != std::string::npos ||
         name == "output/run/bytes";
}

herr_t take(hid_t file, const char* name, const H5O_info_t* info, void* into) {
  if (info->type != H5O_TYPE_DATASET || is_clock(name)) return 0;
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(set),
              space = H5Dget_space(set);
  const auto numbers = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  std::vector<unsigned char> bytes(numbers * H5Tget_size(type));
  const herr_t read =
      bytes.empty() ? 0 : H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
  bytes.push_back(static_cast<unsigned char>(H5Tget_class(type)));
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
  static_cast<Arrays*>(into)->emplace(name, std::move(bytes));
  return read;
}

Arrays arrays_of(const char* path) {
  Arrays found;
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0 || H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, take, &found, H5O_INFO_BASIC) < 0)
    found.clear();
  if (file >= 0) H5Fclose(file);
  return found;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: sphgeo_same_state ONE TWO\n");
    return 2;
  }
  const Arrays one = arrays_of(argv[1]), two = arrays_of(argv[2]);
  if (one.empty() || two.empty()) {
    std::fprintf(stderr, "%s: no checkpoint that can be read\n", one.empty() ? argv[1] : argv[2]);
    return 1;
  }
  bool same = true;
  std::size_t bytes = 0;
  for (const auto& [name, values] : one) {
    const auto other = two.find(name);
    bytes += values.size() - 1;
    if (other != two.end() && other->second == values) continue;
    std::printf("%s %s\n", name.c_str(), other == two.end() ? "is in the first only" : "differs");
    same = false;
  }
  for (const auto& [name, values] : two)
    if (!one.contains(name)) {
      std::printf("%s is in the second only\n", name.c_str());
      same = false;
    }
  if (same) std::printf("%zu arrays, %zu bytes\n", one.size(), bytes);
  return same ? 0 : 1;
}
