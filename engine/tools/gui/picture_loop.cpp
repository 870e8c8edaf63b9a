#include "engine/tools/gui/picture_loop.h"

#include <algorithm>
#include <ostream>
#include <utility>

#include "engine/core/file.h"
#include "engine/tools/gui/numbered_file.h"

namespace palp {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kFramePeriod = 1.0 / 60; ///< shortest period of pictures [s]
constexpr double kQuick       = 12e-3;    ///< longest time of a fine picture that replaces fast ones [s]
constexpr double kRest        = 0.8;      ///< time without changes after which a fine picture is due [s]

bool empty(const glm::ivec2& size)
{
    return size.x < 1 || size.y < 1;
}

std::string saved(const Image& image)
{
    const auto file = unusedPath("palpate", ".png");
    writeFileWhole(file, [&](std::ostream& stream) { stream << encodePng(image); });
    return file.string();
}

} // namespace

PictureLoop::PictureLoop(Screen& screen) : screen_(screen), shownAt_(Clock::now()), changedAt_(shownAt_) {}

double PictureLoop::patience(const glm::ivec2& size) const
{
    constexpr double kIdle = 0.1; // period of looks at a window in which nothing happens [s]
    return restsFine_ || empty(size) ? kIdle : std::max(0.0, kFramePeriod - sinceBegin());
}

bool PictureLoop::due(const glm::ivec2& size) const
{
    return !empty(size) && (!restsFine_ || changedAt_ > begunAt_);
}

double PictureLoop::sinceBegin() const
{
    return Seconds(Clock::now() - begunAt_).count();
}

void PictureLoop::begin(const glm::ivec2& size)
{
    begunAt_         = Clock::now();
    const bool rests = Seconds(begunAt_ - changedAt_).count() > kRest;
    const bool fine  = rests || (fineTime_ > 0 && fineTime_ < kQuick);
    restsFine_       = rests;
    size_            = {size.x, size.y, 1, fine ? Detail::fine : Detail::fast};
}

void PictureLoop::show(const ViewScene& scene, const Camera& camera, const Overlay* texts, bool touching)
{
    const bool shown = screen_.show(scene, camera, size_, texts);
    const auto end   = Clock::now();
    drawnSize_       = {size_.width, size_.height};
    drawTime_        = Seconds(end - begunAt_).count();
    if (size_.detail == Detail::fine) fineTime_ = drawTime_;
    restsFine_          = restsFine_ && shown && fineTime_ >= kQuick;
    const double period = Seconds(end - shownAt_).count();
    const bool   timed  = !std::exchange(rested_, false); // or else most of the period is the rest
    if (timed) frameTime_ += 0.1 * (period - frameTime_);
    if (shown) count(touching && timed, period);
    shownAt_ = end;
}

void PictureLoop::count(bool touching, double period)
{
    constexpr std::size_t kMost = 1'000'000; // five hours
    ++report_.frames;
    if (!touching || report_.frameTimes.size() >= kMost) return;
    report_.frameTimes.push_back(period);
    report_.drawTimes.push_back(drawTime_);
}

void PictureLoop::showWords(const ViewScene& words, const Camera& camera, const glm::ivec2& size, double scale)
{
    if (empty(size)) return;
    const Overlay texts = annotations(words, camera, size.x, size.y, scale);
    static_cast<void>(screen_.show(words, camera, {size.x, size.y, 1, Detail::fast}, &texts));
    screen_.present();
}

std::string PictureLoop::saveStill(ViewScene& scene, const Camera& camera, const std::string& title)
{
    scene.brush.clear(); // a tool, not a part of what is shown
    Camera middle = camera;
    middle.centre = {}; // no panel covers a part of it
    Image image   = screen_.draw(scene, middle, {size_.width, size_.height, 2, Detail::fine}, nullptr);
    scene.title   = title;
    scene.note.clear();
    annotate(image, scene, middle);
    return saved(image);
}

std::string PictureLoop::saveWindow(const ViewScene& scene, const Camera& camera, const Overlay* texts)
{
    return saved(screen_.draw(scene, camera, {size_.width, size_.height, 1, Detail::fine}, texts));
}

} // namespace palp
