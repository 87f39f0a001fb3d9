#include "world_render.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

namespace thicket::gui {
namespace {

/// From 0xAARRGGBB.
void to_texture(std::vector<std::uint32_t>& pixels) {
  for (std::uint32_t& p : pixels) p = (p & 0xff00ff00u) | (p >> 16 & 0xffu) | (p & 0xffu) << 16;
}

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> number{0};
  return ++number;
}

/// How long the coarsest picture may take, s.
constexpr double patience = 0.04;

}  // namespace

float WorldImage::depth_at(double u, double v) const {
  const int column = std::clamp(static_cast<int>((u + 1.0) * 0.5 * width), 0, width - 1), row = std::clamp(static_cast<int>((1.0 - v) * 0.5 * height), 0, height - 1);
  return depth[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
}

WorldRender::~WorldRender() {
  {
    const std::scoped_lock lock(mutex_);
    quit_ = true;
    ++request_;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool WorldRender::is_wanted(const Scene& scene, const PictureView& view) const {
  if (!wanted_) return false;
  const PictureView& before = wanted_->view;
  // (`wanted_` holds the world of its scene: no other can have that address.)
  return &wanted_->scene.world() == &scene.world() && (!scene.moves() || wanted_->scene.time() == scene.time()) && *before.from == *view.from && *before.at == *view.at &&
         before.fov_deg == view.fov_deg && before.width == view.width && before.height == view.height;
}

void WorldRender::ask(const Scene& scene, const PictureView& view) {
  {
    const std::scoped_lock lock(mutex_);
    if (is_wanted(scene, view)) return;
    wanted_.emplace(Wanted{scene, view});
    ++request_;
  }
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  wake_.notify_all();
}

std::shared_ptr<const WorldImage> WorldRender::newest() const {
  const std::scoped_lock lock(mutex_);
  return image_;
}

std::shared_ptr<const WorldImage> WorldRender::now(const Scene& scene, const PictureView& view) {
  {
    const std::scoped_lock lock(mutex_);
    if (image_ && image_->finest && is_wanted(scene, view)) return image_;
  }
  auto image = std::make_shared<WorldImage>();
  if (!draw_world_pixels(scene, view, 4, image->pixels, &image->depth)) return nullptr;
  to_texture(image->pixels);
  image->view = view;
  image->width = view.width;
  image->height = view.height;
  image->finest = true;
  image->number = next_number();
  const std::scoped_lock lock(mutex_);
  wanted_.emplace(Wanted{scene, view});
  ++request_;
  image_ = image;
  return image;
}

void WorldRender::work() {
  std::uint64_t done = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return quit_ || (request_ != done && wanted_); });
    if (quit_) return;
    const Wanted wanted = *wanted_;
    done = request_;
    lock.unlock();
    refine(wanted, done);
    lock.lock();
  }
}

std::optional<Scene> WorldRender::shown(const Wanted& wanted) {
  const auto hidden = hidden_solids(wanted.scene.world(), wanted.view);
  if (!hidden) return std::nullopt;
  if (!kept_from_ || &kept_from_->world() != &wanted.scene.world() || kept_hidden_ != *hidden) {
    auto rest = without(wanted.scene, *hidden);
    if (!rest) return std::nullopt;
    kept_from_ = wanted.scene;
    kept_hidden_ = *hidden;
    kept_ = std::move(*rest);
  }
  Scene scene = *kept_;
  scene.set_time(wanted.scene.time());
  return scene;
}

void WorldRender::refine(const Wanted& wanted, std::uint64_t request) {
  const auto scene = shown(wanted);
  if (!scene) return;
  const Bounds subject = picture_subject(wanted.scene.world());
  int divider = 1;
  while (divider < 32 && wanted.view.width * wanted.view.height * seconds_per_pixel_ > patience * divider * divider) divider *= 2;
  for (bool coarsest = true; divider >= 1; divider = divider > 1 ? std::max(1, divider / 3) : 0, coarsest = false) {
    PictureView view = wanted.view;
    view.width = std::max(1, view.width / divider);
    view.height = std::max(1, view.height / divider);
    if (!paint(WorldPainter(*scene, view, subject), wanted.view, 1, !coarsest, request)) return;
  }
  paint(WorldPainter(*scene, wanted.view, subject), wanted.view, 4, true, request);
}

bool WorldRender::paint(const WorldPainter& painter, const PictureView& full, int samples, bool give_up, std::uint64_t request) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  auto image = std::make_shared<WorldImage>();
  image->view = full;
  image->width = painter.view().width;
  image->height = painter.view().height;
  const auto width = static_cast<std::size_t>(image->width), count = width * static_cast<std::size_t>(image->height);
  image->pixels.resize(count);
  image->depth.resize(count);
  for (int row = 0; row < image->height; ++row) {
    painter.paint_row(row, samples, image->pixels.data() + static_cast<std::size_t>(row) * width);
    painter.measure_row(row, image->depth.data() + static_cast<std::size_t>(row) * width);
    const std::scoped_lock lock(mutex_);
    if (quit_ || (give_up && request_ != request)) return false;
  }
  to_texture(image->pixels);
  image->finest = samples > 1;
  image->number = next_number();
  if (samples == 1) seconds_per_pixel_ = std::chrono::duration<double>(Clock::now() - begun).count() / static_cast<double>(count);
  const std::scoped_lock lock(mutex_);
  if (request_ != request && give_up) return false;
  image_ = std::move(image);
  return request_ == request;
}

}  // namespace thicket::gui
