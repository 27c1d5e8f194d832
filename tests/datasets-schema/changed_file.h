#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "datasets-schema/recording/sample_recording.h"
#include "hdf5/h5.h"
#include "support/program.h"

namespace kerf::test {

/// A sound recording into which somebody put a hand.
class ChangedFile {
 public:
  explicit ChangedFile(const std::function<void(hid_t file)>& change) : path_(folder_ / "changed.h5") {
    schema::write_recording(path_, sample_recording());
    auto file = schema::h5::WritableFile::open(path_);
    change(file.id());
    file.close();
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

inline void remove_link(hid_t file, const std::string& path) {
  schema::h5::call(H5Ldelete, file, path.c_str(), H5P_DEFAULT);
}

inline void remove_attribute(hid_t file, const std::string& object, const std::string& name) {
  schema::h5::delete_attribute(schema::h5::open(file, object).id(), name);
}

inline void set_text(hid_t file, const std::string& object, const std::string& name,
                     const std::string& text) {
  const auto handle = schema::h5::open(file, object);
  if (schema::h5::has_attribute(handle.id(), name)) schema::h5::delete_attribute(handle.id(), name);
  schema::h5::write_attribute(handle.id(), name, text);
}

template <typename T>
void set_number(hid_t file, const std::string& object, const std::string& name, T number) {
  const auto handle = schema::h5::open(file, object);
  if (schema::h5::has_attribute(handle.id(), name)) schema::h5::delete_attribute(handle.id(), name);
  schema::h5::write_attribute(handle.id(), name, schema::h5::native<T>(), {}, &number);
}

template <typename T>
void set_values(hid_t file, const std::string& path, const std::vector<T>& values) {
  schema::h5::write(schema::h5::open(file, path).id(), schema::h5::native<T>(), values.data());
}

/// Puts another dataset in the place of one, without units or scale.
template <typename T>
void replace_dataset(hid_t file, const std::string& path, const schema::h5::Extent& extent) {
  remove_link(file, path);
  static_cast<void>(
      schema::h5::create_dataset(file, path, schema::h5::native<T>(), {.extent = extent, .chunk_rows = 16}));
}

}  // namespace kerf::test
