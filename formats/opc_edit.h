// The XML that holds a package together, changed where something is added and else left as it is.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fretwork {

/// `[Content_Types].xml` with a type for every path; types that are there stay.
/// \param paths  with a leading slash
std::string with_content_types(std::string_view xml, std::span<const std::string> paths);

/// The types that it gives to these paths, with a leading slash; empty where it gives none.
std::vector<std::string> content_types_of(std::string_view xml, std::span<const std::string> paths);

/// A target with its leading slash, and the type of the relationship.
using Relation = std::pair<std::string, std::string_view>;

/// A relationships part with these as well, under names of their own; those that are there already are not repeated.
std::string with_relations(std::string_view xml, std::span<const Relation> relations);

/// A relationships part without those that lead to any of these targets.
/// \param targets  with a leading slash, in lower case
std::string without_relations_to(std::string_view xml, const std::set<std::string>& targets);

/// Where the first relationship of a type leads, with a leading slash; empty when there is none.
std::string target_of_relation(std::string_view xml, std::string_view type);

/// The first relationship of a type led to another target.
std::string with_relation_target(std::string_view xml, std::string_view type, std::string_view target);

/// "3D/a.model" -> "3D/_rels/a.model.rels"
std::string relations_part_of(std::string_view part);

}  // namespace fretwork
