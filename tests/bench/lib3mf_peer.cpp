#include "lib3mf_peer.h"

#include <Model/COM/NMR_DLLInterfaces.h>

#include <string>
#include <vector>

#include "core/base/error.h"

namespace fretwork::bench {
namespace {

/// Something of lib3mf's; given back when this goes.
class Handle {
  public:
    Handle() = default;
    ~Handle() {
        if (base_ != nullptr) NMR::lib3mf_release(base_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    NMR::PLib3MFBase** to_fill() { return &base_; }
    [[nodiscard]] NMR::PLib3MFBase* get() const { return base_; }

  private:
    NMR::PLib3MFBase* base_ = nullptr;
};

void check(LIB3MFRESULT result, const char* step, const Handle& from) {
    if (result == 0) return;
    DWORD code = 0;
    LPCSTR text = nullptr;
    if (from.get() != nullptr) NMR::lib3mf_getlasterror(from.get(), &code, &text);
    throw FileError("lib3mf: " + std::string(step) + " gives " + std::to_string(static_cast<std::uint32_t>(result)) +
                    (text != nullptr ? std::string(" (") + text + ")" : ""));
}

}  // namespace

std::uint64_t lib3mf_read(const std::filesystem::path& path) {
    Handle model, reader, meshes;
    check(NMR::lib3mf_createmodel(model.to_fill()), "createmodel", model);
    check(NMR::lib3mf_model_queryreader(model.get(), "3mf", reader.to_fill()), "queryreader", model);
    check(NMR::lib3mf_reader_readfromfileutf8(reader.get(), path.c_str()), "readfromfile", reader);
    check(NMR::lib3mf_model_getmeshobjects(model.get(), meshes.to_fill()), "getmeshobjects", model);
    std::uint64_t triangles = 0;
    for (BOOL more = 0; NMR::lib3mf_resourceiterator_movenext(meshes.get(), &more) == 0 && more != 0;) {
        Handle mesh;
        check(NMR::lib3mf_resourceiterator_getcurrent(meshes.get(), mesh.to_fill()), "getcurrent", meshes);
        DWORD count = 0;
        check(NMR::lib3mf_meshobject_gettrianglecount(mesh.get(), &count), "gettrianglecount", mesh);
        triangles += count;
    }
    return triangles;
}

void lib3mf_write(const std::filesystem::path& path, const TriangleMesh& mesh) {
    std::vector<NMR::MODELMESHVERTEX> vertices(mesh.positions_mm.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        for (int k = 0; k < 3; ++k) vertices[v].m_fPosition[k] = static_cast<float>(mesh.positions_mm[v][k]);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(mesh.triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) triangles[t].m_nIndices[k] = mesh.triangles[t][k];
    Handle model, object, item, writer;
    check(NMR::lib3mf_createmodel(model.to_fill()), "createmodel", model);
    check(NMR::lib3mf_model_addmeshobject(model.get(), object.to_fill()), "addmeshobject", model);
    check(NMR::lib3mf_meshobject_setgeometry(object.get(), vertices.data(), static_cast<DWORD>(vertices.size()),
                                             triangles.data(), static_cast<DWORD>(triangles.size())),
          "setgeometry", object);
    check(NMR::lib3mf_model_addbuilditem(model.get(), object.get(), nullptr, item.to_fill()), "addbuilditem", model);
    check(NMR::lib3mf_model_querywriter(model.get(), "3mf", writer.to_fill()), "querywriter", model);
    check(NMR::lib3mf_writer_writetofileutf8(writer.get(), path.c_str()), "writetofile", writer);
}

}  // namespace fretwork::bench
