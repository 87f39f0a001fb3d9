// Pictures of a world on a thread of its own: a coarse one at once, finer ones while nobody asks for another. Private to the room.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "thicket/sim/simulation.hpp"
#include "thicket/sim/world_picture.hpp"

namespace thicket::gui {

struct WorldImage {
  PictureView view;                   ///< as it was asked for, in full size
  int width = 0, height = 0;          ///< of what is there
  std::vector<std::uint32_t> pixels;  ///< 0xAABBGGRR, as textures take them
  std::vector<float> depth;           ///< m from the camera; +inf: sky
  bool finest = false;
  std::uint64_t number = 0;           ///< another picture has another

  /// u and v in -1...1, from the left and the bottom.
  float depth_at(double u, double v) const;
};

class WorldRender {
 public:
  WorldRender() = default;
  ~WorldRender();
  WorldRender(const WorldRender&) = delete;
  WorldRender& operator=(const WorldRender&) = delete;

  /// Asks for a picture; the same as before changes nothing. Never waits.
  void ask(const Scene& scene, const PictureView& view);
  /// The best of the newest that there is; null: none yet.
  std::shared_ptr<const WorldImage> newest() const;
  /// The finest at once, in this thread; nothing if it cannot be drawn.
  std::shared_ptr<const WorldImage> now(const Scene& scene, const PictureView& view);

 private:
  struct Wanted {
    Scene scene;
    PictureView view;
  };
  bool is_wanted(const Scene& scene, const PictureView& view) const;
  void work();
  void refine(const Wanted& wanted, std::uint64_t request);
  /// Whether it was finished: what is coarsest always is.
  bool paint(const WorldPainter& painter, const PictureView& full, int samples, bool give_up, std::uint64_t request);
  /// The scene without what the view hides; kept, for it takes long to build.
  std::optional<Scene> shown(const Wanted& wanted);

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Wanted> wanted_;
  std::uint64_t request_ = 0;
  bool quit_ = false;
  std::shared_ptr<const WorldImage> image_;
  std::thread thread_;

  // Of the thread alone.
  double seconds_per_pixel_ = 4e-6;
  std::optional<Scene> kept_from_, kept_;
  std::vector<bool> kept_hidden_;
};

}  // namespace thicket::gui
