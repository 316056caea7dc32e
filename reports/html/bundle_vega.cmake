# cmake -DVEGA=folder -DOUTPUT=file -P bundle_vega.cmake: Debian ships Vega's packages one a file, as
# UMD modules that share one global name; this puts those that the pages need behind one `vega`.
set(modules util time format loader.browser dataflow canvas.browser scale scenegraph expression
  event-selector selection statistics functions parser runtime view transforms encode
  view-transforms)
file(WRITE ${OUTPUT}.partial "(function(root){'use strict';var made={};function need(name){return made[name];}\n")
foreach(module IN LISTS modules)
  set(file ${VEGA}/vega-${module}.min.js)
  if(NOT EXISTS ${file})
    set(file ${VEGA}/vega-${module}.js)
  endif()
  file(READ ${file} text)
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" text "${text}")
  string(REPLACE ".browser" "" name ${module})
  if(name STREQUAL "selection")
    set(name selections)
  endif()
  file(APPEND ${OUTPUT}.partial "(function(exports,module,require){\n${text}\n}).call(root,made['vega-${name}']={},{exports:made['vega-${name}']},need);\n")
endforeach()
file(APPEND ${OUTPUT}.partial
  "var vega={};Object.keys(made).forEach(function(name){Object.assign(vega,made[name]);});\n"
  "Object.assign(vega.transforms,made['vega-transforms'],made['vega-view-transforms'],made['vega-encode']);\n"
  "root.vega=vega;})(typeof globalThis!=='undefined'?globalThis:this);\n")
file(RENAME ${OUTPUT}.partial ${OUTPUT})
