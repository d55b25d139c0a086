// Where things stand in the text of a model part.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/threemf_model.h"
#include "formats/xml_spans.h"

namespace fretwork::threemf {

/// An object with a mesh.
struct ObjectPlace {
    XmlTag object;
    XmlTag mesh;
    TextSpan mesh_content;                      ///< between <mesh> and </mesh>
    std::optional<XmlAttributeSpan> volume;     ///< the mesh's volumeid
    std::vector<XmlAttributeSpan> slices;       ///< attributes by which the object names slices of itself
    std::vector<std::string> beside_triangles;  ///< further elements of the mesh, which refer to its vertices
};

struct MetadataPlace {
    std::string space;  ///< namespace of the name's prefix; empty without one
    std::string name;   ///< without the prefix
    TextSpan span;      ///< of the whole element
};

struct ModelLayout {
    XmlTag model;
    std::size_t resources = 0;  ///< where <resources> begins
    std::map<ResourceId, ObjectPlace> objects;
    std::set<ResourceId> ids;  ///< of all resources
    std::vector<MetadataPlace> metadata;
    std::map<std::string, std::string> declared;          ///< prefix -> namespace, on <model>
    std::map<std::string, std::set<std::string>> spaces;  ///< prefix -> every namespace it stands for anywhere
};

/// \param xml  a model part that ModelReader has read without complaint, in UTF-8; must outlive the layout
ModelLayout layout_of(std::string_view xml);

}  // namespace fretwork::threemf
