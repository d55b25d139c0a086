// Parts and faces of a model as named facts.
#pragma once

#include "formats/facts_text.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Name and number of triangles.
Facts part_facts(const MeshPart& part);

/// The same of a face of a CAD model, with area, centre of area and mean normal, so that one can tell which is meant.
/// A face that closes upon itself, such as all round a hole, has no mean normal.
Facts face_facts(const TriangleMesh& mesh, const MeshPart& face);

}  // namespace fretwork
