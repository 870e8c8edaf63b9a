#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/recording.h"
#include "tests/support/temporary_folder.h"

namespace palp::soak {

/// A recording whose disk is full after some bytes, and the check that nothing is lost that was said to be saved.
/// Makes a limit of the process while it lives, so that nothing else may write meanwhile.
class FaultyRecording {
public:
    /// \param mostBytes  of a file
    FaultyRecording(const Scene& scene, std::uint64_t mostBytes);
    ~FaultyRecording();
    FaultyRecording(const FaultyRecording&)            = delete;
    FaultyRecording& operator=(const FaultyRecording&) = delete;

    void push(const TickRecord& record);

    /// Ends it and reads it back.
    /// \return what is wrong, as a sentence; empty if nothing is
    [[nodiscard]] std::optional<std::string> finish();

private:
    TemporaryFolder            folder_;
    std::vector<std::string>   said_;
    std::vector<TickRecord>    pushed_;
    std::unique_ptr<Recording> recording_;
};

} // namespace palp::soak
