# `cmake --install`: program, models and every notice.
include(GNUInstallDirs)
if(TARGET vitruvian)
  install(TARGETS vitruvian RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
foreach(model generated/body.vbm generated/blazepose_detector.opencv.onnx generated/blazepose_landmarks.opencv.onnx
        pose_prior.vpp landmarks.json)
  install(FILES ${CMAKE_SOURCE_DIR}/models/${model} DESTINATION ${CMAKE_INSTALL_DATADIR}/vitruvian OPTIONAL)
endforeach()
install(FILES LICENSE THIRD_PARTY.md CITATION.cff CHANGELOG.md README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY scripts/licences DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES models/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/models)
