#include "core/render/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/thread_order.h"

namespace fretwork {

struct RayScene::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    ~Embree() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

RayScene::RayScene(const TriangleMesh& mesh, const RunControl& run) : embree_(std::make_unique<Embree>()) {
    Vec3 low = mesh.positions_mm[mesh.triangles[0][0]], high = low;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            low = low.cwiseMin(mesh.positions_mm[v]);
            high = high.cwiseMax(mesh.positions_mm[v]);
        }
    center_mm_ = low / 2 + high / 2;
    half_diagonal_mm_ = (high / 2 - low / 2).norm();
    if (!(half_diagonal_mm_ > 0)) half_diagonal_mm_ = 1;

    embree_->device = rtcNewDevice(nullptr);
    if (embree_->device == nullptr) throw SolverFailure("render: Embree found no usable processor features");
    embree_->scene = rtcNewScene(embree_->device);
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    // The Morton-code builder: several times faster to build, and its tree does not depend on the number of threads,
    // which would decide between two triangles where a ray meets their common edge.
    rtcSetSceneBuildQuality(embree_->scene, RTC_BUILD_QUALITY_LOW);
    const RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions_mm.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (positions == nullptr || indices == nullptr) {
        rtcReleaseGeometry(geometry);
        throw MemoryLimit("render: not enough memory for " + std::to_string(mesh.triangles.size()) + " triangles");
    }
    parallel_for(mesh.positions_mm.size(), 16384, [&](std::size_t v) {
        // A vertex that no triangle uses may be anything.
        const Vec3 p = to_scene(mesh.positions_mm[v]);
        for (int k = 0; k < 3; ++k)
            positions[3 * v + static_cast<std::size_t>(k)] = p.allFinite() ? static_cast<float>(p[k]) : 0.0f;
    });
    parallel_for(mesh.triangles.size(), 16384,
                 [&](std::size_t t) { std::copy_n(mesh.triangles[t].begin(), 3, indices + 3 * t); });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_->scene, geometry);
    rtcReleaseGeometry(geometry);
    struct Building {
        const RunControl& run;
        ThreadOrder order;
    } building = {run, {}};
    rtcSetSceneProgressMonitorFunction(
        embree_->scene,
        [](void* self, double) {
            auto& b = *static_cast<Building*>(self);
            const ThreadOrder::Task running(b.order);
            return !b.run.stop_requested();
        },
        &building);
    rtcCommitScene(embree_->scene);
    rtcSetSceneProgressMonitorFunction(embree_->scene, nullptr, nullptr);
    run.throw_if_stopped();
    if (const RTCError error = rtcGetDeviceError(embree_->device); error != RTC_ERROR_NONE)
        throw SolverFailure("render: Embree could not build its tree (error " + std::to_string(error) + ")");
}

namespace {

RTCRay endless_ray(const Vec3f& origin, const Vec3f& direction) {
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    return ray;
}

}  // namespace

RayScene::~RayScene() = default;

std::optional<RayScene::Hit> RayScene::first_hit(const Vec3f& origin, const Vec3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = endless_ray(origin, direction);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    Vec3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    normal.normalize();
    if (normal.dot(direction) > 0) normal = -normal;
    return Hit{query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v, normal};
}

bool RayScene::is_blocked(const Vec3f& origin, const Vec3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = endless_ray(origin, direction);
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace fretwork
