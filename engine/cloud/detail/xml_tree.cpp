#include "engine/cloud/detail/xml_tree.h"

#include <algorithm>
#include <array>

#include "engine/cloud/tokens.h"

namespace palp {
namespace {

constexpr std::size_t kMostElements = 20'000; ///< real files have some dozen for each piece
constexpr std::size_t kMostDepth    = 32;     ///< real files have eight
constexpr std::size_t kMostValues   = 64;     ///< attributes of an element; real ones have a dozen

bool isNameCharacter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.' || c == ':';
}

class XmlParser {
public:
    XmlParser(const WholeFile& file, std::string_view rawName) : file_(file), rest_(file.text), rawName_(rawName) {}

    std::pair<XmlElement, std::string_view> parse()
    {
        if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
        skipBlanks();
        if (rest_.starts_with("<?")) static_cast<void>(upTo("?>", "the first line"));
        skipComments();
        if (!rest_.starts_with('<')) fail("expected XML, which begins with <");
        XmlElement root = element(0);
        if (raw_) return {std::move(root), *raw_};
        skipComments();
        if (!rest_.empty()) fail("expected the end of the file after its root");
        return {std::move(root), {}};
    }

private:
    [[noreturn]] void fail(const std::string& message) const
    {
        file_.failAtLine(rest_.data(), message + ", found " +
                                           (rest_.empty() ? "the end of the file" : inQuotes(rest_.substr(0, 20))));
    }

    void skipBlanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }

    void skipComments()
    {
        for (skipBlanks(); rest_.starts_with("<!--"); skipBlanks()) static_cast<void>(upTo("-->", "a comment"));
    }

    /// Passes over a text and its end.
    std::string_view upTo(std::string_view end, const char* what)
    {
        const std::size_t at = rest_.find(end);
        if (at == std::string_view::npos) fail("expected " + std::string(end) + " at the end of " + what);
        const std::string_view passed = rest_.substr(0, at);
        rest_.remove_prefix(at + end.size());
        return passed;
    }

    std::string_view name()
    {
        const auto             end  = std::find_if_not(rest_.begin(), rest_.end(), isNameCharacter);
        const std::string_view word = rest_.substr(0, std::size_t(end - rest_.begin()));
        if (word.empty()) fail("expected a name");
        rest_.remove_prefix(word.size());
        return word;
    }

    bool passed(std::string_view token)
    {
        if (!rest_.starts_with(token)) return false;
        rest_.remove_prefix(token.size());
        return true;
    }

    std::string withoutEntities(std::string_view text) const
    {
        constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
            {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
        std::string plain;
        while (!text.empty()) {
            const auto entity = std::find_if(kEntities.begin(), kEntities.end(),
                                             [&](const auto& known) { return text.starts_with(known.first); });
            plain += entity == kEntities.end() ? text.front() : entity->second;
            text.remove_prefix(entity == kEntities.end() ? 1 : entity->first.size());
        }
        return plain;
    }

    void readAttributes(XmlElement& element)
    {
        for (skipBlanks(); !rest_.starts_with('>') && !rest_.starts_with("/>"); skipBlanks()) {
            const std::string_view key = name();
            skipBlanks();
            if (!passed("=")) fail("expected = after attribute " + inQuotes(key));
            skipBlanks();
            const bool isSingle = rest_.starts_with('\'');
            if (!isSingle && !rest_.starts_with('"')) fail("expected the value of " + inQuotes(key) + " in quotes");
            rest_.remove_prefix(1);
            const std::string_view value = upTo(isSingle ? "'" : "\"", "a value");
            if (element.attributes.size() == kMostValues)
                fail("expected at most " + std::to_string(kMostValues) + " attributes");
            if (element.attribute(key)) fail("expected attribute " + inQuotes(key) + " once");
            element.attributes.emplace_back(key, withoutEntities(value));
        }
    }

    XmlElement element(std::size_t depth)
    {
        if (++elements_ > kMostElements || depth > kMostDepth)
            fail("expected at most " + std::to_string(kMostElements) + " elements, " + std::to_string(kMostDepth) +
                 " within each other");
        rest_.remove_prefix(1); // <
        XmlElement element;
        element.name = name();
        element.text = rest_.substr(0, 0); // part of the file even if empty: errors count lines up to it
        readAttributes(element);
        if (passed("/>")) return element;
        rest_.remove_prefix(1); // >
        if (element.name == rawName_ && depth == 1) {
            raw_ = rest_;
            return element;
        }
        const std::size_t textEnd = std::min(rest_.find('<'), rest_.size());
        element.text              = rest_.substr(0, textEnd);
        rest_.remove_prefix(textEnd);
        for (;;) {
            skipComments();
            if (passed("</")) break;
            if (!rest_.starts_with('<') || rest_.starts_with("<!") || rest_.starts_with("<?"))
                fail("expected an element or </" + shownText(element.name, kMostOfWord) + ">");
            element.children.push_back(this->element(depth + 1));
            if (raw_) return element;
            const std::size_t next = std::min(rest_.find('<'), rest_.size()); // text between children is not used
            rest_.remove_prefix(next);
        }
        if (name() != element.name) fail("expected the end of " + inQuotes(element.name));
        skipBlanks();
        if (!passed(">")) fail("expected >");
        return element;
    }

    const WholeFile&                file_;
    std::string_view                rest_;
    std::string_view                rawName_;
    std::optional<std::string_view> raw_;
    std::size_t                     elements_ = 0;
};

} // namespace

std::optional<std::string_view> XmlElement::attribute(std::string_view key) const
{
    for (const auto& [known, value] : attributes)
        if (known == key) return value;
    return std::nullopt;
}

const XmlElement* XmlElement::child(std::string_view key) const
{
    const auto found =
        std::find_if(children.begin(), children.end(), [&](const XmlElement& e) { return e.name == key; });
    return found == children.end() ? nullptr : &*found;
}

std::pair<XmlElement, std::string_view> parseXml(const WholeFile& file, std::string_view rawName)
{
    return XmlParser(file, rawName).parse();
}

} // namespace palp
