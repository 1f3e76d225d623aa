# Installs the libraries of BUILD into FOLDER, and builds and runs there a project that replays a recording with them.
include("${CMAKE_CURRENT_LIST_DIR}/install.cmake")
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${FOLDER}/build" "-DCMAKE_PREFIX_PATH=${FOLDER}/prefix")
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")

file(WRITE "${FOLDER}/cell.yaml" "name: bench
units: {length: m, angle: rad}
objects:
  - {name: hand, sphere: {radius: 0.1}}
  - {name: box, fixed: true, box: {size: [0.2, 0.2, 0.2]}}
pairs:
  - {between: [hand, box]}
")
file(WRITE "${FOLDER}/poses.csv" "t_ns,object,px,py,pz,qw,qx,qy,qz
1000000,hand,0,0,0.51,1,0,0,0
2000000,hand,0,0,0.5,1,0,0,0
")
run("${BUILD}/bin/clearance-record" --from-csv "${FOLDER}/poses.csv" -o "${FOLDER}/run.mcap" --cell "${FOLDER}/cell.yaml")
run("${FOLDER}/build/uses_replay" "${FOLDER}/cell.yaml" "${FOLDER}/run.mcap")
