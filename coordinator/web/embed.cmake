# Embeds the files of the dashboard's page into the coordinator's program.
# Usage: cmake -DOUT=page_files.cpp -DFOLDER=page -DMADE=downloads -P embed.cmake
# FOLDER: the folder of the page's files in the repository. MADE: the folder of further files, which the build makes. Writes OUT, a C++ file
# that has the bytes of all files of both folders and defines page_files() (coordinator/web/page_files.h).
set(types_html "text/html; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_svg "image/svg+xml")
set(types_zip "application/zip")
set(types_py "text/x-python; charset=utf-8")

file(GLOB files ${FOLDER}/* ${MADE}/*)
list(SORT files)
set(arrays "")
set(table "")
set(number 0)
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME)
  get_filename_component(suffix ${file} LAST_EXT)
  string(SUBSTRING ${suffix} 1 -1 suffix)
  if(NOT DEFINED types_${suffix})
    message(FATAL_ERROR "${file}: no type is known for .${suffix}")
  endif()
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
  string(APPEND arrays "constexpr char kFile${number}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", \"${types_${suffix}}\", {kFile${number}, sizeof(kFile${number})}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT}.new "#include \"coordinator/web/page_files.h\"

namespace bandsaw::coordinator {
namespace {

${arrays}
constexpr PageFile kFiles[] = {
${table}};

}  // namespace

absl::Span<const PageFile> page_files() { return kFiles; }

}  // namespace bandsaw::coordinator
")
file(RENAME ${OUT}.new ${OUT})
