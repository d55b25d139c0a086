#include "formats/threemf_objects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "formats/length_unit.h"
#include "formats/slicer_names.h"

namespace fretwork {
namespace {

using threemf::Build;
using threemf::Instance;
using threemf::Object;
using threemf::ObjectKey;

void add_once(std::vector<std::string>& names, const std::string& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
}

class ObjectLister {
  public:
    explicit ObjectLister(Build& build) : build_(build), names_(threemf::slicer_names(build.package())) {}

    std::vector<ThreemfObject> list() {
        for (const Instance& item : build_.root().items)
            visit(Build::key_of(build_.root_part(), item), item.transform, item.printable);
        const double mm = millimeters_per(build_.root().unit);
        for (ThreemfObject& listed : objects_) {
            Object object = build_.take(listed.key);
            listed.mesh = std::move(object.mesh);
            listed.triangle_colors = std::move(object.triangle_colors);
            if (mm != 1.0)
                for (Vec3& p : listed.mesh.positions_mm) p *= mm;
        }
        return std::move(objects_);
    }

  private:
    /// Assemblies without a mesh below them are walked all the same; Build has checked how many placements there are.
    void visit(const ObjectKey& key, const Eigen::Affine3d& transform, bool printable) {
        const Object& object = build_.object(key);
        if (!object.mesh.triangles.empty()) note(key, object, transform, printable);
        if (object.components.empty()) return;
        path_.push_back(key);
        for (const Instance& component : object.components)
            visit(Build::key_of(key.part, component), transform * component.transform, printable);
        path_.pop_back();
    }

    void note(const ObjectKey& key, const Object& object, const Eigen::Affine3d& transform, bool printable) {
        const double scale = std::cbrt(std::abs(transform.linear().determinant()));
        const auto [entry, added] = known_.emplace(key, objects_.size());
        if (added) {
            ThreemfObject& listed = objects_.emplace_back();
            listed.key = key;
            listed.name = name_of(key);
            listed.part_number = object.part_number;
            listed.type = object.type;
            listed.least_scale = listed.most_scale = scale;
        }
        ThreemfObject& listed = objects_[entry->second];
        ++listed.instances;
        listed.printable = listed.printable || printable;
        listed.least_scale = std::min(listed.least_scale, scale);
        listed.most_scale = std::max(listed.most_scale, scale);
        for (const ObjectKey& parent : path_) {
            if (std::ranges::find(listed.parents, parent) == listed.parents.end()) listed.parents.push_back(parent);
            add_once(listed.parent_names, name_of(parent));
            add_once(listed.parent_names, build_.object(parent).part_number);
        }
    }

    /// Its own name, else the slicer's.
    [[nodiscard]] std::string name_of(const ObjectKey& key) const {
        const auto named = names_.find(key.id);
        const std::string& own = build_.object(key).name;
        return own.empty() && named != names_.end() && key.part == build_.root_part() ? named->second : own;
    }

    Build& build_;
    std::map<threemf::ResourceId, std::string> names_;
    std::vector<ObjectKey> path_;
    std::map<ObjectKey, std::size_t> known_;
    std::vector<ThreemfObject> objects_;
};

}  // namespace

ThreemfObjects read_threemf_objects(std::string_view bytes, std::string_view source, const ThreemfReadOptions& options,
                                    const RunControl& run) {
    Build build(bytes, source, options, run);
    ThreemfObjects found;
    found.unit_mm = millimeters_per(build.root().unit);
    found.warnings = build.warnings();
    found.objects = ObjectLister(build).list();
    return found;
}

}  // namespace fretwork
