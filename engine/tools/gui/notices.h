#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace palp {

/// Holds the sentences that the window shows to its user: the last message, what is being done, and what went wrong.
/// Invariant: there are at most five faults, and no two in a row are the same.
/// \thread the window's
class Notices {
public:
    /// \param complained  is called with each new fault; may be empty
    explicit Notices(std::function<void(const std::string&)> complained) : complained_(std::move(complained)) {}

    void say(const std::string& message);
    void complain(const std::string& fault);
    void clearMessage() { message_.clear(); }
    void clearFaults() { faults_.clear(); }

    /// Names the activity of another thread; an empty name ends it.
    void               setActivity(const std::string& activity);
    [[nodiscard]] bool busy() const { return !activity_.empty(); }

    [[nodiscard]] const std::string& message() const { return message_; }
    /// Returns the activity, or the message if there is none.
    [[nodiscard]] const std::string&              current() const { return busy() ? activity_ : message_; }
    [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

    /// Returns the number of changes that a new picture would show.
    [[nodiscard]] std::uint64_t changes() const { return changes_; }

private:
    std::function<void(const std::string&)> complained_;
    std::string                             message_, activity_;
    std::vector<std::string>                faults_; ///< oldest first
    std::uint64_t                           changes_ = 0;
};

} // namespace palp
