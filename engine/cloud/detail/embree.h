#pragma once
#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "engine/core/contract.h"

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PALP_THREAD_SANITIZER 1
#endif
#elif defined(__SANITIZE_THREAD__)
#define PALP_THREAD_SANITIZER 1
#endif

namespace palp {

/// Answers point queries over boxes, by Embree 3 or 4. Internal to the cloud layer: the only file that names Embree.
///
/// The boxes are primitives of one user geometry, because point queries never visit Embree's own point primitives.
/// Embree orders its leaves by primitive number, so the tree, and with it the order of the visits, does not depend
/// on the number of threads that built it. Nor does it on the processor, of those with AVX2: Embree's trees are as wide
/// as the registers that it uses, and sums over points in another order round otherwise. AVX-512 would gain nothing.
/// \thread const calls from any number of threads at once
class BoxTree {
public:
    struct Box {
        glm::vec3 low{};
        glm::vec3 high{};
    };

private:
    struct Release {
        void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
        void operator()(RTCGeometry geometry) const noexcept { rtcReleaseGeometry(geometry); }
    };

public:
    /// What trees that belong together are made on: to start one takes longer than to build a small tree.
    using Device = std::shared_ptr<std::remove_pointer_t<RTCDevice>>;

    /// \throws Error if Embree does not start
    [[nodiscard]] static Device newDevice()
    {
        Device device(rtcNewDevice(kConfiguration), [](RTCDevice d) {
            if (d) rtcReleaseDevice(d);
        });
        if (!device)
            throw Error("Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                        "); is there enough memory?");
        return device;
    }

    /// \throws Error if Embree runs out of memory
    BoxTree(Device device, const std::vector<Box>& boxes) : device_(std::move(device))
    {
        scene_.reset(rtcNewScene(device_.get()));
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(boxes.size()));
        // Only `bounds` reads them, and only while the scene is committed.
        rtcSetGeometryUserData(geometry.get(), const_cast<Box*>(boxes.data()));
        rtcSetGeometryBoundsFunction(geometry.get(), bounds, nullptr);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        rtcCommitScene(scene_.get());
        if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
            throw Error("Embree cannot build a tree of " + std::to_string(boxes.size()) + " boxes (error " +
                        std::to_string(error) + "); is there enough memory?");
    }

    /// Calls visit(box number, radius) for every box within `radius` of `centre`, near ones first, and for some that
    /// are further away. `visit` may shrink the radius.
    template <class Visit>
    void query(const glm::vec3& centre, float radius, Visit&& visit) const
    {
        RTCPointQuery query{}; // the type is declared with the 16-byte alignment that Embree demands
        query.x      = centre.x;
        query.y      = centre.y;
        query.z      = centre.z;
        query.radius = radius;
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        Call<std::remove_reference_t<Visit>> call{visit, {}};
        // The function is given here and not to the geometry as well: every hit would come twice.
        rtcPointQuery(scene_.get(), &query, &context, call.visited, &call);
        if (call.failure) std::rethrow_exception(call.failure);
    }

private:
    // ThreadSanitizer does not see how Embree's builders hand over to TBB's workers, and reports false races. The
    // setting is for it only: TBB's threads in the whole process are limited for as long as Embree's own device lives.
#if defined(PALP_THREAD_SANITIZER)
    static constexpr const char* kConfiguration = "max_isa=avx2,threads=1";
#else
    static constexpr const char* kConfiguration = "max_isa=avx2";
#endif

    /// Calls `visit`. An exception may not pass through Embree, which would swallow it: it waits for the query to end.
    template <class Visit>
    struct Call {
        Visit&             visit;
        std::exception_ptr failure;

        static bool visited(RTCPointQueryFunctionArguments* args) noexcept
        {
            auto&       self   = *static_cast<Call*>(args->userPtr);
            const float before = args->query->radius;
            try {
                if (!self.failure) self.visit(args->primID, args->query->radius);
            } catch (...) {
                self.failure = std::current_exception();
            }
            return args->query->radius != before;
        }
    };

    static void bounds(const RTCBoundsFunctionArguments* args)
    {
        const Box& box          = static_cast<const Box*>(args->geometryUserPtr)[args->primID];
        args->bounds_o->lower_x = box.low.x;
        args->bounds_o->lower_y = box.low.y;
        args->bounds_o->lower_z = box.low.z;
        args->bounds_o->upper_x = box.high.x;
        args->bounds_o->upper_y = box.high.y;
        args->bounds_o->upper_z = box.high.z;
    }

    using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release>;

    Device                                                    device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

} // namespace palp
