#include "formats/threemf_reader.h"

#include <utility>

#include "formats/color_channel.h"

namespace fretwork {
namespace {

using threemf::Build;
using threemf::Instance;
using threemf::Object;
using threemf::ObjectKey;

/// The meshes of the build in one.
class BuildFlattener {
  public:
    BuildFlattener(Build& build, const std::map<ObjectKey, MeshToWrite>& replaced, const RunControl& run)
        : build_(build), replaced_(replaced), run_(run), mm_(millimeters_per(build.root().unit)) {}

    MeshFile flatten() {
        for (const Instance& item : build_.root().items) count_placements(Build::key_of(build_.root_part(), item));
        for (const Instance& item : build_.root().items) {
            const auto first = static_cast<std::uint32_t>(file_.mesh.triangles.size());
            const ObjectKey key = Build::key_of(build_.root_part(), item);
            place(key, item.transform);
            const auto count = static_cast<std::uint32_t>(file_.mesh.triangles.size()) - first;
            if (count > 0) file_.parts.push_back({build_.object(key).name, first, count});
        }
        file_.unit = build_.root().unit;
        if (mm_ != 1.0)
            for (Vec3& p : file_.mesh.positions_mm) p *= mm_;
        if (!file_.triangle_colors.empty()) file_.triangle_colors.resize(file_.mesh.triangles.size(), kUncolored);
        file_.warnings = build_.warnings();
        if (left_out_ > 0)
            file_.warnings.push_back(std::to_string(left_out_) + " support or other objects were left out");
        return std::move(file_);
    }

  private:
    void count_placements(const ObjectKey& key) {
        ++left_to_place_[key];
        for (const Instance& component : build_.object(key).components)
            count_placements(Build::key_of(key.part, component));
    }

    void place(const ObjectKey& key, const Eigen::Affine3d& transform) {
        run_.throw_if_stopped();
        const Object& object = build_.object(key);
        if (object.type != "model" && object.type != "surface") {
            ++left_out_;
            return;
        }
        const auto other = replaced_.find(key);
        const bool last = --left_to_place_.at(key) == 0;
        if (other != replaced_.end()) {
            append(key, other->second, transform * Eigen::Scaling(1.0 / mm_));
        } else if (!object.mesh.triangles.empty()) {
            if (last && file_.mesh.positions_mm.empty())
                take_over(key, transform);
            else
                append(key, {object.mesh, object.triangle_colors}, transform);
            if (last) build_.object(key).mesh = {};
        }
        for (const Instance& component : object.components)
            place(Build::key_of(key.part, component), transform * component.transform);
    }

    [[nodiscard]] Vec3 placed(const ObjectKey& key, const Vec3& p, const Eigen::Affine3d& transform) const {
        const Vec3 result = transform * p;
        if (!(result.cwiseAbs().maxCoeff() <= kMaxCoordinate))
            build_.fail(key.part, build_.object(key).line, "a placed coordinate over 1e9 in size", "a smaller one");
        return result;
    }

    /// Puts the mesh of an object in an empty file, without a second copy of it.
    /// \param transform  into the unit of the root model
    void take_over(const ObjectKey& key, const Eigen::Affine3d& transform) {
        Object& object = build_.object(key);
        file_.mesh = std::move(object.mesh);
        file_.triangle_colors = std::move(object.triangle_colors);
        for (Vec3& p : file_.mesh.positions_mm) p = placed(key, p, transform);
        if (transform.linear().determinant() < 0.0)
            for (Triangle& t : file_.mesh.triangles) std::swap(t[1], t[2]);
    }

    /// \param transform  into the unit of the root model
    void append(const ObjectKey& key, const MeshToWrite& input, const Eigen::Affine3d& transform) {
        const auto base = static_cast<std::uint32_t>(file_.mesh.positions_mm.size());
        for (const Vec3& p : input.mesh.positions_mm) file_.mesh.positions_mm.push_back(placed(key, p, transform));
        const bool mirrored = transform.linear().determinant() < 0.0;
        for (Triangle t : input.mesh.triangles) {
            if (mirrored) std::swap(t[1], t[2]);
            file_.mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        }
        if (input.triangle_colors.empty()) return;
        auto& colors = file_.triangle_colors;
        colors.resize(file_.mesh.triangles.size() - input.mesh.triangles.size(), kUncolored);
        colors.insert(colors.end(), input.triangle_colors.begin(), input.triangle_colors.end());
    }

    Build& build_;
    const std::map<ObjectKey, MeshToWrite>& replaced_;
    const RunControl& run_;
    double mm_;
    std::map<ObjectKey, std::size_t> left_to_place_;
    std::size_t left_out_ = 0;
    MeshFile file_;
};

}  // namespace

MeshFile read_threemf(std::string_view bytes, std::string_view source, const RunControl& run,
                      const ThreemfReadOptions& options) {
    return read_threemf_with(bytes, source, {}, run, options);
}

MeshFile read_threemf_with(std::string_view bytes, std::string_view source,
                           const std::map<threemf::ObjectKey, MeshToWrite>& replaced, const RunControl& run,
                           const ThreemfReadOptions& options) {
    return flatten_build(Build(bytes, source, options, run), replaced, run);
}

MeshFile flatten_build(Build build, const std::map<ObjectKey, MeshToWrite>& replaced, const RunControl& run) {
    return BuildFlattener(build, replaced, run).flatten();
}

}  // namespace fretwork
