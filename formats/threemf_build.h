// A 3MF package with its model parts, read when they are first referred to; and what its build unfolds to.
#pragma once

#include <compare>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "formats/threemf_model.h"
#include "formats/threemf_package.h"

namespace fretwork {

struct ThreemfReadOptions {
    /// Reads on where the model requires an extension that is not known; there is a warning then.
    bool ignore_required = false;
};

namespace threemf {

/// An object and the model part that holds it.
struct ObjectKey {
    std::string part;  ///< without a leading slash
    ResourceId id = 0;
    auto operator<=>(const ObjectKey&) const = default;
};

/// Guards: at most 4096 model parts, 32 levels of components, no cycles, at most 16384 placed meshes and
/// 524288 placed objects; and placing
/// may not make more than 4 M triangles or twice those stored.
class Build {
  public:
    /// The bytes must outlive it.
    /// \throws InvalidInput  see Package and ModelReader; an empty build; beyond the guards. Names part and line.
    Build(std::string_view bytes, std::string_view source, const ThreemfReadOptions& options, const RunControl& run);

    [[nodiscard]] const Package& package() const { return package_; }
    [[nodiscard]] const std::string& root_part() const { return package_.model_part(); }
    [[nodiscard]] const Model& root() const { return models_.at(root_part()); }

    /// Every model part that the build refers to.
    [[nodiscard]] const std::map<std::string, Model>& models() const { return models_; }

    /// Of an item or component that stands in `part`.
    static ObjectKey key_of(const std::string& part, const Instance& instance);

    /// An object that the build refers to, directly or not.
    [[nodiscard]] const Object& object(const ObjectKey& key) const { return models_.at(key.part).objects.at(key.id); }

    /// The same, to take its mesh out where nothing else is going to ask for it.
    [[nodiscard]] Object& object(const ObjectKey& key) { return models_.at(key.part).objects.at(key.id); }

    /// Hands over what the meshes are held in; the triangles of `object` are empty then.
    [[nodiscard]] Object take(const ObjectKey& key) { return std::move(models_.at(key.part).objects.at(key.id)); }

    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

    /// \throws InvalidInput
    [[noreturn]] void fail(const std::string& part, std::size_t line, std::string_view found,
                           std::string_view expected) const;

  private:
    /// What an object unfolds to; counted once per object, so that a tree of references that doubles at
    /// every level costs nothing.
    struct Unfolded {
        std::uint64_t objects = 1;  ///< with itself
        std::uint64_t meshes = 0;
        std::uint64_t triangles = 0;
        std::size_t depth = 1;
    };

    const Model& model_of(const std::string& part);
    const Object& find(const ObjectKey& key, const std::string& from, std::size_t line);
    Unfolded unfold(const ObjectKey& key, const std::string& from, std::size_t line);
    void check_sizes();

    std::string source_;
    ThreemfReadOptions options_;
    const RunControl& run_;
    Package package_;
    std::map<std::string, Model> models_;
    std::map<ObjectKey, Unfolded> unfolded_;
    std::set<ObjectKey> open_;  ///< on the way from the build to the object in hand
    std::uint64_t stored_triangles_ = 0;
    std::vector<std::string> warnings_;
};

}  // namespace threemf
}  // namespace fretwork
