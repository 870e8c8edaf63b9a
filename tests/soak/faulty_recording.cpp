#include "tests/soak/faulty_recording.h"

#include <csignal>
#include <cstring>

#include <sys/resource.h>

#include "engine/session/recorded_session.h"

namespace palp::soak {
namespace {

void limitFiles(rlim_t bytes)
{
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) throw Error("the limit on sizes of files cannot be set");
}

} // namespace

FaultyRecording::FaultyRecording(const Scene& scene, std::uint64_t mostBytes)
{
    std::signal(SIGXFSZ, SIG_IGN); // as the programs do: the write fails instead
    const SessionInfo info{.scene    = scene,
                           .versions = {{"palpate", "soak"}},
                           .solver   = "host",
                           .clock    = SessionClock::virtualTime,
                           .command  = "palp_soak"};
    recording_ =
        std::make_unique<Recording>(folder_ / "run", info, [this](const std::string& why) { said_.push_back(why); });
    limitFiles(mostBytes);
}

FaultyRecording::~FaultyRecording()
{
    recording_.reset();
    limitFiles(RLIM_INFINITY);
}

void FaultyRecording::push(const TickRecord& record)
{
    pushed_.push_back(asStored(record));
    recording_->pushWaiting(record);
}

std::optional<std::string> FaultyRecording::finish()
{
    const RecordingReport report = recording_->finish();
    limitFiles(RLIM_INFINITY);
    if (report.ticks + report.lost != pushed_.size())
        return "the recording counts " + std::to_string(report.ticks) + " ticks kept and " +
               std::to_string(report.lost) + " lost of " + std::to_string(pushed_.size());
    if (report.lost > 0 && (!report.stopped || said_.size() != 1))
        return "the recording lost ticks and said nothing of it";
    const RecordedSession kept = readSession(folder_ / "run");
    if (kept.records.size() != report.ticks)
        return "the recording holds " + std::to_string(kept.records.size()) + " ticks and counts " +
               std::to_string(report.ticks);
    for (std::size_t n = 0; n < kept.records.size(); ++n)
        if (std::memcmp(&kept.records[n], &pushed_[n], sizeof(TickRecord)) != 0)
            return "tick " + std::to_string(n) + " of the recording is another one";
    return {};
}

} // namespace palp::soak
