#include "formats/threemf_reader.h"

#include <algorithm>
#include <map>
#include <set>

#include "formats/color_channel.h"
#include "formats/parse_error.h"
#include "formats/threemf_package.h"

namespace fretwork {
namespace {

using threemf::Instance;
using threemf::Model;
using threemf::Object;

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxParts = 4096;
constexpr std::uint64_t kMaxPlaced = 16384;
constexpr std::uint64_t kFreeTriangles = 4 << 20;

/// An object and the model part that holds it.
struct ObjectKey {
    std::string part;
    threemf::ResourceId id = 0;
    auto operator<=>(const ObjectKey&) const = default;
};

class BuildExpander {
  public:
    BuildExpander(std::string_view bytes, std::string_view source, const RunControl& run)
        : source_(source), run_(run), package_(bytes, source) {}

    MeshFile expand() {
        const std::string root = package_.model_part();
        const Model& model = model_of(root);
        if (model.items.empty()) fail(root, 0, "an empty build", "at least one item");
        check_sizes(root, model);
        for (const Instance& item : model.items) {
            const auto first = static_cast<std::uint32_t>(file_.mesh.triangles.size());
            const ObjectKey key = key_of(root, item);
            place(key, item.transform);
            const auto count = static_cast<std::uint32_t>(file_.mesh.triangles.size()) - first;
            if (count > 0) file_.parts.push_back({object_of(key, root, item.line).name, first, count});
        }
        finish(model);
        return std::move(file_);
    }

  private:
    /// What an object unfolds to; counted once per object, so that a tree of references that doubles at
    /// every level costs nothing.
    struct Unfolded {
        std::uint64_t meshes = 0;
        std::uint64_t triangles = 0;
        std::size_t depth = 1;
    };

    [[noreturn]] void fail(const std::string& part, std::size_t line, std::string_view found,
                           std::string_view expected) const {
        fail_parse(source_ + ": " + part, place_of_line(line), found, expected);
    }

    const Model& model_of(const std::string& part) {
        const auto known = models_.find(part);
        if (known != models_.end()) return known->second;
        if (models_.size() >= kMaxParts) fail(part, 0, "over 4096 model parts", "fewer");
        Model& model = models_[part] = package_.read_model(part, run_);
        for (const auto& [id, object] : model.objects) stored_triangles_ += object.mesh.triangles.size();
        for (const std::string& warning : model.warnings) file_.warnings.push_back(part + ": " + warning);
        return model;
    }

    static ObjectKey key_of(const std::string& part, const Instance& instance) {
        return {instance.part.empty() ? part : std::string(threemf::without_slash(instance.part)), instance.object};
    }

    const Object& object_of(const ObjectKey& key, const std::string& from, std::size_t line) {
        const Model& model = model_of(key.part);
        const auto object = model.objects.find(key.id);
        if (object == model.objects.end())
            fail(from, line, "object " + std::to_string(key.id) + ", which " + in_quotes(key.part) + " does not hold",
                 "an object");
        return object->second;
    }

    Unfolded unfold(const ObjectKey& key, const std::string& from, std::size_t line) {
        const Object& object = object_of(key, from, line);
        const auto known = unfolded_.find(key);
        if (known != unfolded_.end()) return known->second;
        if (!open_.insert(key).second)
            fail(key.part, object.line, "object " + std::to_string(key.id) + " within itself", "no cycle");
        const auto check_depth = [&](std::size_t depth) {
            if (depth > kMaxDepth) fail(key.part, object.line, "components over 32 levels deep", "fewer");
        };
        check_depth(open_.size());
        Unfolded sum{object.mesh.triangles.empty() ? 0u : 1u, object.mesh.triangles.size(), 1};
        for (const Instance& component : object.components) {
            const Unfolded part = unfold(key_of(key.part, component), key.part, component.line);
            // Sums stop growing far beyond the limits and far below what the type can hold.
            sum.meshes = std::min(sum.meshes + part.meshes, std::uint64_t{1} << 40);
            sum.triangles = std::min(sum.triangles + part.triangles, std::uint64_t{1} << 40);
            sum.depth = std::max(sum.depth, part.depth + 1);
        }
        check_depth(sum.depth);
        open_.erase(key);
        return unfolded_[key] = sum;
    }

    void check_sizes(const std::string& root, const Model& model) {
        Unfolded sum;
        for (const Instance& item : model.items) {
            const Unfolded part = unfold(key_of(root, item), root, item.line);
            sum.meshes += part.meshes;
            sum.triangles += part.triangles;
        }
        if (sum.meshes > kMaxPlaced)
            fail(root, 0, std::to_string(sum.meshes) + " placed meshes", "at most " + std::to_string(kMaxPlaced));
        const std::uint64_t most = std::max(kFreeTriangles, 2 * stored_triangles_);
        if (sum.triangles > most)
            fail(root, 0, std::to_string(sum.triangles) + " placed triangles", "at most " + std::to_string(most));
    }

    void place(const ObjectKey& key, const Eigen::Affine3d& transform) {
        run_.throw_if_stopped();
        const Object& object = models_.at(key.part).objects.at(key.id);
        if (object.type != "model" && object.type != "surface") {
            ++left_out_;
            return;
        }
        if (!object.mesh.triangles.empty()) append_mesh(key, object, transform);
        for (const Instance& component : object.components)
            place(key_of(key.part, component), transform * component.transform);
    }

    void append_mesh(const ObjectKey& key, const Object& object, const Eigen::Affine3d& transform) {
        const auto base = static_cast<std::uint32_t>(file_.mesh.positions_mm.size());
        for (const Vec3& p : object.mesh.positions_mm) {
            const Vec3 placed = transform * p;
            if (!(placed.cwiseAbs().maxCoeff() <= kMaxCoordinate))
                fail(key.part, object.line, "a placed coordinate over 1e9 in size", "a smaller one");
            file_.mesh.positions_mm.push_back(placed);
        }
        const bool mirrored = transform.linear().determinant() < 0.0;
        for (Triangle t : object.mesh.triangles) {
            if (mirrored) std::swap(t[1], t[2]);
            file_.mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        }
        if (object.triangle_colors.empty()) return;
        auto& colors = file_.triangle_colors;
        colors.resize(file_.mesh.triangles.size() - object.mesh.triangles.size(), kUncolored);
        colors.insert(colors.end(), object.triangle_colors.begin(), object.triangle_colors.end());
    }

    void finish(const Model& root) {
        file_.unit = root.unit;
        const double scale = millimeters_per(root.unit);
        if (scale != 1.0)
            for (Vec3& p : file_.mesh.positions_mm) p *= scale;
        if (!file_.triangle_colors.empty()) file_.triangle_colors.resize(file_.mesh.triangles.size(), kUncolored);
        if (left_out_ > 0)
            file_.warnings.push_back(std::to_string(left_out_) + " support or other objects were left out");
        file_.warnings.insert(file_.warnings.end(), package_.warnings().begin(), package_.warnings().end());
    }

    std::string source_;
    const RunControl& run_;
    threemf::Package package_;
    std::map<std::string, Model> models_;
    std::map<ObjectKey, Unfolded> unfolded_;
    std::set<ObjectKey> open_;  ///< on the way from the build to the object in hand
    std::uint64_t stored_triangles_ = 0;
    std::size_t left_out_ = 0;
    MeshFile file_;
};

}  // namespace

MeshFile read_threemf(std::string_view bytes, std::string_view source, const RunControl& run) {
    return BuildExpander(bytes, source, run).expand();
}

}  // namespace fretwork
