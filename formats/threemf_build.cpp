#include "formats/threemf_build.h"

#include <algorithm>

#include "formats/parse_error.h"

namespace fretwork::threemf {
namespace {

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxParts = 4096;
constexpr std::uint64_t kMaxPlaced = 16384;
constexpr std::uint64_t kMaxObjects = kMaxPlaced * kMaxDepth;
constexpr std::uint64_t kFreeTriangles = 4 << 20;

}  // namespace

Build::Build(std::string_view bytes, std::string_view source, const ThreemfReadOptions& options, const RunControl& run)
    : source_(source), options_(options), run_(run), package_(bytes, source) {
    if (model_of(root_part()).items.empty()) fail(root_part(), 0, "an empty build", "at least one item");
    check_sizes();
    warnings_.insert(warnings_.end(), package_.warnings().begin(), package_.warnings().end());
}

ObjectKey Build::key_of(const std::string& part, const Instance& instance) {
    return {instance.part.empty() ? part : std::string(without_slash(instance.part)), instance.object};
}

void Build::fail(const std::string& part, std::size_t line, std::string_view found, std::string_view expected) const {
    fail_parse(source_ + ": " + part, place_of_line(line), found, expected);
}

const Model& Build::model_of(const std::string& part) {
    const auto known = models_.find(part);
    if (known != models_.end()) return known->second;
    if (models_.size() >= kMaxParts) fail(part, 0, "over 4096 model parts", "fewer");
    Model& model = models_[part] = package_.read_model(part, options_.ignore_required, run_);
    for (const auto& [id, object] : model.objects) stored_triangles_ += object.mesh.triangles.size();
    for (const std::string& warning : model.warnings) warnings_.push_back(part + ": " + warning);
    return model;
}

const Object& Build::find(const ObjectKey& key, const std::string& from, std::size_t line) {
    const Model& model = model_of(key.part);
    const auto object = model.objects.find(key.id);
    if (object == model.objects.end())
        fail(from, line, "object " + std::to_string(key.id) + ", which " + in_quotes(key.part) + " does not hold",
             "an object");
    return object->second;
}

Build::Unfolded Build::unfold(const ObjectKey& key, const std::string& from, std::size_t line) {
    const Object& object = find(key, from, line);
    const auto known = unfolded_.find(key);
    if (known != unfolded_.end()) return known->second;
    if (!open_.insert(key).second)
        fail(key.part, object.line, "object " + std::to_string(key.id) + " within itself", "no cycle");
    const auto check_depth = [&](std::size_t depth) {
        if (depth > kMaxDepth) fail(key.part, object.line, "components over 32 levels deep", "fewer");
    };
    check_depth(open_.size());
    Unfolded sum{1, object.mesh.triangles.empty() ? 0u : 1u, object.mesh.triangles.size(), 1};
    for (const Instance& component : object.components) {
        const Unfolded part = unfold(key_of(key.part, component), key.part, component.line);
        // Sums stop growing far beyond the limits and far below what the type can hold.
        sum.objects = std::min(sum.objects + part.objects, std::uint64_t{1} << 40);
        sum.meshes = std::min(sum.meshes + part.meshes, std::uint64_t{1} << 40);
        sum.triangles = std::min(sum.triangles + part.triangles, std::uint64_t{1} << 40);
        sum.depth = std::max(sum.depth, part.depth + 1);
    }
    check_depth(sum.depth);
    if (object.mesh.triangles.empty() && object.components.empty())
        warnings_.push_back(key.part + ": object " + std::to_string(key.id) +
                            " has no triangles, or a shape of an extension that is not read");
    open_.erase(key);
    return unfolded_[key] = sum;
}

void Build::check_sizes() {
    const std::string& part = root_part();
    Unfolded sum;
    for (const Instance& item : root().items) {
        const Unfolded unfolded = unfold(key_of(part, item), part, item.line);
        sum.objects += unfolded.objects;
        sum.meshes += unfolded.meshes;
        sum.triangles += unfolded.triangles;
    }
    if (sum.meshes > kMaxPlaced)
        fail(part, 0, std::to_string(sum.meshes) + " placed meshes", "at most " + std::to_string(kMaxPlaced));
    if (sum.objects > kMaxObjects)
        fail(part, 0, std::to_string(sum.objects) + " placed objects", "at most " + std::to_string(kMaxObjects));
    const std::uint64_t most = std::max(kFreeTriangles, 2 * stored_triangles_);
    if (sum.triangles > most)
        fail(part, 0, std::to_string(sum.triangles) + " placed triangles", "at most " + std::to_string(most));
}

}  // namespace fretwork::threemf
