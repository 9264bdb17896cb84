# Part of `cmake --install`: copies the shared libraries of `program` to lib/vitruvian under the names they are asked for by,
# and the copyright notices of the Debian packages they come from to `licences`. glibc and its loader stay the system's.
set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
file(GET_RUNTIME_DEPENDENCIES
  EXECUTABLES "${program}"
  RESOLVED_DEPENDENCIES_VAR libraries
  UNRESOLVED_DEPENDENCIES_VAR missing
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv|util|anl|nsl|mvec)\\.so")
if(missing)
  message(FATAL_ERROR "${program} needs shared libraries that are not on this machine: ${missing}")
endif()
set(packages)
foreach(library ${libraries})
  get_filename_component(name "${library}" NAME)
  file(REAL_PATH "${library}" file)
  message(STATUS "Bundling: ${name}")
  file(MAKE_DIRECTORY "${prefix}/lib/vitruvian")
  file(COPY_FILE "${file}" "${prefix}/lib/vitruvian/${name}" ONLY_IF_DIFFERENT)
  # dpkg knows a file below /lib by the path it was packed with.
  string(REGEX REPLACE "^/usr/lib/" "/lib/" merged "${file}")
  execute_process(COMMAND dpkg-query -S "${file}" "${merged}" OUTPUT_VARIABLE owner ERROR_QUIET)
  if(owner MATCHES "^([^:, ]+)")
    list(APPEND packages "${CMAKE_MATCH_1}")
  else()
    message(WARNING "${file} belongs to no Debian package: add its licence by hand")
  endif()
endforeach()
list(REMOVE_DUPLICATES packages)
foreach(package ${packages})
  file(MAKE_DIRECTORY "${prefix}/${licences}")
  file(COPY_FILE "/usr/share/doc/${package}/copyright" "${prefix}/${licences}/${package}.txt" ONLY_IF_DIFFERENT)
endforeach()
