// The few calls and names that differ between Embree 3 and 4, in one place. Private to scene.cpp.
#pragma once

#if __has_include(<embree4/rtcore.h>) && !defined(THICKET_EMBREE3)
#include <embree4/rtcore.h>
#define THICKET_EMBREE_MAJOR 4
#else
#include <embree3/rtcore.h>
#define THICKET_EMBREE_MAJOR 3
#endif

namespace thicket::embree {

#if THICKET_EMBREE_MAJOR == 4
using Context = RTCRayQueryContext;
inline void start(Context& context) { rtcInitRayQueryContext(&context); }
inline void intersect8(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &rays, &arguments);
}
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
#else
using Context = RTCIntersectContext;
inline void start(Context& context) {
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
}
inline void intersect8(const int* valid, RTCScene scene, Context& context, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context, &rays); }
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
#endif

}  // namespace thicket::embree
