#include "engine/tools/cli/manual.h"

#include <CLI/CLI.hpp>

namespace palp {
namespace {

/// Returns a text as man prints it: a hyphen stays a hyphen, and no line begins with a request.
std::string roff(const std::string& text)
{
    std::string result;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const char c           = text[n];
        const bool beginsALine = n == 0 || text[n - 1] == '\n';
        if (beginsALine && (c == '.' || c == '\'')) result += "\\&";
        if (c == '\\')
            result += "\\e";
        else if (c == '-')
            result += "\\-";
        else
            result += c;
    }
    return result;
}

std::vector<const CLI::Option*> shownOptions(const CLI::App& app)
{
    return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Returns "--cells INT [128]", as the help has it.
std::string titleOf(const CLI::App& app, const CLI::Option& option)
{
    const auto* lines = dynamic_cast<const CLI::Formatter*>(app.get_formatter().get());
    const bool  named = !option.get_positional();
    return option.get_name(!named, true) + (lines ? lines->make_option_opts(&option) : "");
}

std::string optionsOf(const CLI::App& app)
{
    std::string text;
    for (const CLI::Option* option : shownOptions(app))
        text += ".TP\n.B " + roff(titleOf(app, *option)) + "\n" + roff(option->get_description()) + "\n";
    return text;
}

std::string asPrinted(const std::string& text)
{
    return text.empty() ? "" : ".PP\n.nf\n" + roff(text) + "\n.fi\n";
}

/// Returns the pattern of a shell's case for a command's own name and the words that complete it.
std::string completionsOf(const CLI::App& app, const std::string& pattern)
{
    std::string words;
    for (const CLI::App* command : commandsOf(app)) words += command->get_name() + " ";
    for (const CLI::Option* option : shownOptions(app))
        for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
    if (!words.empty()) words.pop_back();
    return "    " + pattern + ") words='" + words + "' ;;\n";
}

} // namespace

std::string manualPage(const CLI::App& app)
{
    std::string page = ".TH PALPATE 1 \"\" \"palpate " PALPATE_VERSION "\" \"User Commands\"\n"
                       ".SH NAME\npalpate \\- touch of thin, soft objects whose stiffness varies\n"
                       ".SH SYNOPSIS\n.B palpate\n.I COMMAND\n[OPTIONS]\n"
                       ".SH DESCRIPTION\n" +
                       roff(app.get_description()) + "\n.SH OPTIONS\n" + optionsOf(app) + ".SH COMMANDS\n";
    for (const CLI::App* command : commandsOf(app))
        page += ".SS palpate " + roff(command->get_name()) + "\n" + roff(command->get_description()) + "\n" +
                optionsOf(*command) + asPrinted(command->get_footer());
    return page + ".SH EXAMPLES\n" + asPrinted(app.get_footer());
}

std::string bashCompletion(const CLI::App& app)
{
    std::string script = "# Completion of palpate's commands and options for bash, made by palpate --completion.\n"
                         "_palpate()\n{\n"
                         "    local words word=${COMP_WORDS[COMP_CWORD]} command=\n"
                         "    [ \"$COMP_CWORD\" -le 1 ] || command=${COMP_WORDS[1]}\n"
                         "    case $command in\n";
    for (const CLI::App* command : commandsOf(app)) script += completionsOf(*command, command->get_name());
    script += completionsOf(app, "''") + "    *) words= ;;\n"
                                         "    esac\n"
                                         "    COMPREPLY=()\n"
                                         "    if [ -z \"$command\" ] || [ \"${word#-}\" != \"$word\" ]; then\n"
                                         "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
                                         "    fi\n"
                                         "}\n"
                                         "complete -o default -F _palpate palpate\n";
    return script;
}

} // namespace palp
