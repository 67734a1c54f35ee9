#include "perf/csv.h"

namespace slabcast {

namespace {

std::string quoted(std::string text) {
    if (text.find_first_of(",\"\n") == std::string::npos) {
        return text;
    }
    for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) {
        text.insert(at, 1, '"');
    }
    return '"' + text + '"';
}

std::string cellOf(const Json& row, const char* pointer) {
    const Json* value = row.atPointer(pointer);
    return value == nullptr || value->isNull() ? ""
           : value->isText()                   ? quoted(value->text())
                                               : value->dump();
}

} // namespace

std::vector<CsvColumn> columnsOf(std::initializer_list<std::span<const CsvColumn>> parts) {
    std::vector<CsvColumn> columns;
    for (const std::span<const CsvColumn> part : parts) {
        columns.insert(columns.end(), part.begin(), part.end());
    }
    return columns;
}

std::string csvOf(const Json& rows, std::span<const CsvColumn> columns) {
    std::string text;
    const auto endLine = [&text] { text.back() = '\n'; };
    for (const CsvColumn& column : columns) {
        text += std::string(column.heading) + ",";
    }
    endLine();
    for (const Json& row : rows) {
        for (const CsvColumn& column : columns) {
            text += cellOf(row, column.pointer) + ",";
        }
        endLine();
    }
    return text;
}

} // namespace slabcast
