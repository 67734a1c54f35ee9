#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace slabcast {

/// CLI11's help, with defaults in words and lines that fit a terminal.
class HelpFormatter : public CLI::Formatter {
public:
    HelpFormatter();

    std::string make_option_opts(const CLI::Option* option) const override;
    std::string make_option_desc(const CLI::Option* option) const override;
};

/// What bad usage answers with: the cause on one line, then where to read on.
std::string usageMessage(const CLI::App* app, const CLI::Error& error);

} // namespace slabcast
