// Loose faces of a CAD model -> faces that share their edges. Internal to this folder.
#pragma once

#include <TopoDS_Shape.hxx>
#include <vector>

namespace fretwork {

struct SewnShape {
    TopoDS_Shape shape;
    std::vector<TopoDS_Shape> faces;  ///< of `shape`, in the order of their numbers in the file
};

/// IGES holds faces without their neighbours, and so do surface models of STEP: each would be broken into triangles
/// with borders of its own. Faces that meet within 1e-5 of the longest side become one shell, and a closed shell
/// becomes a solid with its outside out. Solids are left as they are.
/// \throws Standard_Failure
SewnShape sew_loose_faces(const TopoDS_Shape& shape, double longest_side);

}  // namespace fretwork
