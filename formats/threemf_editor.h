// A 3MF package with some of its objects carved and all else as it was.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "formats/carved_threemf_writer.h"
#include "formats/threemf_build.h"

namespace fretwork {

/// An object of the package and what takes the place of its mesh; its name is not used.
struct CarvedReplacement {
    threemf::ObjectKey key;
    CarvedObject object;
};

struct ThreemfEdit {
    std::vector<CarvedReplacement> objects;
    PackageRecord record;
};

/// Of a carved object, the content of its `<mesh>`, the mesh's volume data and the object's default colour are
/// replaced; what the carved mesh needs (see `carved_threemf_writer.h`) is defined before it. The record is added,
/// or takes the place of that of an earlier run, whose voxel data go unless something else refers to them. The picture
/// that stands for the package is replaced by the record's, if it has one. Of PrusaSlicer's configuration, the runs of
/// triangles of carved objects follow their meshes.
///
/// Everything else stays byte for byte: the other text of the model parts, with attributes and elements that nobody
/// knows; all other parts, as they are packed; their order. A model part in UTF-16 becomes UTF-8.
class ThreemfEditor {
  public:
    /// Finds the objects that are to be carved. The bytes must outlive it. Holds the text of their model parts.
    /// \throws InvalidInput  no such object; one whose mesh holds a modifier of PrusaSlicer as well; a model part with
    /// a carved object of over 1 GiB; see ZipReader.
    ThreemfEditor(std::string_view bytes, std::string_view source, const std::vector<threemf::ObjectKey>& carved);
    ~ThreemfEditor();
    ThreemfEditor(const ThreemfEditor&) = delete;
    ThreemfEditor& operator=(const ThreemfEditor&) = delete;

    /// What cannot be kept of the carved meshes.
    [[nodiscard]] const std::vector<std::string>& warnings() const;

    /// The new package; the bytes depend on the arguments alone.
    /// \throws InvalidInput  see write_carved_threemf; not the objects that were announced. \throws Cancelled
    [[nodiscard]] std::string write(const ThreemfEdit& edit, const RunControl& run = {}) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
