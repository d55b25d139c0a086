// Image stacks of a 3MF -> fields that can be asked at any point.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "formats/mesh_data.h"
#include "formats/threemf_build.h"

namespace fretwork {

/// The volumetric data of one object, as the volumetric extension (0.8) says: nearest or trilinear,
/// wrapped, mirrored or clamped. Points are in millimetres, before the transforms of build and components.
class VolumetricObject {
  public:
    ~VolumetricObject();
    VolumetricObject(VolumetricObject&&) noexcept;
    VolumetricObject& operator=(VolumetricObject&&) noexcept;

    [[nodiscard]] const std::string& name() const;

    /// Names of the properties, such as "fw:solid".
    [[nodiscard]] std::vector<std::string> properties() const;

    /// Linear sRGB in [0, 1]; empty when the object has no volumetric colour.
    [[nodiscard]] std::optional<Vec3> color(const Vec3& point_mm) const;

    /// Empty when the object has no such property.
    [[nodiscard]] std::optional<double> property(std::string_view name, const Vec3& point_mm) const;

  private:
    struct Impl;
    friend class VolumetricLoader;
    explicit VolumetricObject(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

inline constexpr std::size_t kMaxStoredSamples = std::size_t{1} << 26;

/// Objects with volumetric data, in order of their ids.
/// \throws InvalidInput  see `threemf_reader.h`; also a sheet that is missing or whose size differs from
///     its stack, a number of sheets other than announced, an unknown channel or reference; stacks that hold over
///     `max_samples` in all (two bytes each; the default keeps hostile files under 200 MB), where 8 x 8 pixels of one
///     value count as one, or over 2^30 with all pixels counted.
std::vector<VolumetricObject> read_volumetric_threemf(std::string_view bytes, std::string_view source,
                                                      std::size_t max_samples = kMaxStoredSamples,
                                                      const RunControl& run = {});

struct VolumetricFile {
    MeshFile mesh;
    std::vector<VolumetricObject> objects;
};

/// What `read_threemf` and `read_volumetric_threemf` tell of a package, for the price of reading it once.
/// \throws InvalidInput  as they do. \throws Cancelled
VolumetricFile read_threemf_with_volumes(std::string_view bytes, std::string_view source, const RunControl& run = {},
                                         const ThreemfReadOptions& options = {});

}  // namespace fretwork
